/** The guide: purpose, steps and terms, one page per role. */

import { marked } from '@/language';

/** Made by the tests on a real server (GUIDE_PICTURES=1), so that it shows what is there. */
export interface Picture {
  readonly name: string;
  readonly shows: string;
}
export interface Step {
  readonly title: string;
  readonly text: string;
  readonly to?: { readonly href: string; readonly name: string };
  readonly picture?: Picture;
}
export interface GuidePage {
  readonly role: string;
  readonly name: string;
  readonly purpose: string;
  readonly steps: readonly Step[];
  readonly terms: readonly (readonly [string, string])[];
}

const kSimulated = [
  marked('Simulated'),
  marked('Recorded by a program, not by a person. Simulated trials are marked on every page.'),
] as const;
const kFloor = [
  marked('Noise floor'),
  marked('The error that noise alone causes, estimated from the measurements themselves.'),
] as const;
const kHeldOut = [
  marked('Held-out trials'),
  marked('Trials that a fit did not use. The error on them estimates the error on the next recording.'),
] as const;
const kLearning = [
  marked('LC-CUSUM'),
  marked(
    'A running sum over the trials: correct answers increase it, incorrect answers decrease it. When it reaches the threshold, competence is signalled; from then on, a second sum detects relapse.',
  ),
] as const;

export const kPages: readonly GuidePage[] = [
  {
    role: 'trainee',
    name: marked('Trainee'),
    purpose: marked('Do your assigned trials, blinded, and follow your own progress.'),
    steps: [
      {
        title: marked('See your assignments'),
        text: marked('Your assignments, your progress in each, and the due dates.'),
        to: { href: '/assignments', name: marked('My work') },
      },
      {
        title: marked('Sign in at a station'),
        text: marked(
          'Use your badge number and PIN. The station offers your next trial. Neither the station nor the files on its disk reveal the kind of bone.',
        ),
      },
      {
        title: marked('Palpate or probe, then answer'),
        text: marked(
          'Is there a breach, where, and how confident are you? Your answer ends the trial. In cases without a pre-drilled channel, you first drill the channel; the station then lets you palpate it.',
        ),
      },
      {
        title: marked('See your progress'),
        text: marked(
          'After the results are released: correct answers over the trials, your strengths, and whether your confidence matches your accuracy.',
        ),
        to: { href: '/me', name: marked('My progress') },
        picture: { name: 'trainee', shows: marked('The page of a trainee: summary, learning, competence, confidence') },
      },
    ],
    terms: [
      [marked('Breach'), marked('A place where the channel leaves the bone.')],
      kLearning,
      [
        marked('Confidence'),
        marked(
          'How sure you are of your answer. On the diagonal of the chart, 80 % of the answers with a confidence of 80 % are correct.',
        ),
      ],
    ],
  },
  {
    role: 'faculty',
    name: marked('Faculty'),
    purpose: marked('Create cases, assign them, supervise, debrief, and release results.'),
    steps: [
      {
        title: marked('Create a cohort'),
        text: marked('Enter a name and add trainees by account name. Removing a trainee can be undone.'),
        to: { href: '/network/cohorts', name: marked('Cohorts') },
      },
      {
        title: marked('Upload a volume'),
        text: marked(
          'A folder or a zip of one DICOM series, or a NIfTI or NRRD file. The server takes the patient’s identity out; a director or an administrator looks at the slices and releases the volume.',
        ),
        to: { href: '/volumes', name: marked('Volumes') },
      },
      {
        title: marked('Or import it from the PACS'),
        text: marked(
          'Where the hospital’s PACS is connected, search for a study by patient’s id, day or description, compare its series by spacing and slice thickness, and import one. It is treated as an uploaded volume.',
        ),
        to: { href: '/volumes', name: marked('Volumes') },
      },
      {
        title: marked('Create a case'),
        text: marked(
          'Place the entry and the target of the tract in the slices of a CT. Choose the breached wall and the depth of the breach; the page shows the position of the breach and the thickness of the wall. Alternatively, let the trainee drill the channel and then palpate it. For the probing rig, define the layers and walls of a scenario.',
        ),
        to: { href: '/cases', name: marked('Cases') },
      },
      {
        title: marked('Check what can be felt'),
        text: marked(
          'The page says for each wall whether a breach can be felt, and where best. With filled bone, the dashed outline in the slices is the outer face of the vertebra that was found: where it is wrong, paint “Bone here” or “No bone here”; “Remove marks here” takes marks back. Move the entry or the target until every wall can be felt.',
        ),
        to: { href: '/cases', name: marked('Cases') },
      },
      {
        title: marked('Assign the case'),
        text: marked(
          'Choose a cohort or individual trainees, repeats, order and due date. Each trainee gets an individual, blinded order. Results stay hidden until you release them.',
        ),
        to: { href: '/assignments', name: marked('Assignments') },
      },
      {
        title: marked('Supervise the stations'),
        text: marked(
          'See who is in a trial, for how long and with which force. Stations that need attention are listed first. Stop a trial with a reason.',
        ),
        to: { href: '/wall', name: marked('Live stations') },
      },
      {
        title: marked('Debrief a trial'),
        text: marked(
          'Replay the trial: path of the tip in 3-D, forces, touched walls, force against depth, and an example trial as a ghost. When you point at a time in one chart, all others follow. You can add a comment at that time.',
        ),
        to: { href: '/trials', name: marked('Trials') },
        picture: {
          name: 'faculty',
          shows: marked('A palpation trial: signals, path of the tip in 3-D, touched walls'),
        },
      },
      {
        title: marked('Rate a trial'),
        text: marked(
          'In the debriefing, have a trial rated by a rubric, by how many people, and whether the trainee’s name is hidden until all have rated. Nobody sees another’s rating before that. A submitted rating cannot be changed, only superseded with a reason.',
        ),
        to: { href: '/ratings', name: marked('Ratings') },
      },
    ],
    terms: [
      [
        marked('Walls touched'),
        marked('The unrolled wall of the tract, with the share of each side that the tip touched.'),
      ],
      [marked('Scenario'), marked('The bone of a probing trial: its layers and the walls that are breached.')],
      kSimulated,
    ],
  },
  {
    role: 'director',
    name: marked('Programme director'),
    purpose: marked('See which trainees are on track, have relapsed, or are inactive.'),
    steps: [
      {
        title: marked('Open the list of trainees'),
        text: marked('Filter it by trainees who have relapsed, are learning, or have had no trial for two months.'),
        to: { href: '/trainees', name: marked('Trainees') },
        picture: {
          name: 'director',
          shows: marked('The list of trainees with state, share of correct answers and last trial'),
        },
      },
      {
        title: marked('Open one trainee'),
        text: marked('One page shows the summary, learning, competence, recognition by scenario, and confidence.'),
      },
      { title: marked('Print the page'), text: marked('“Print this page” prints one sheet for the interview.') },
      {
        title: marked('Look at whole cohorts'),
        text: marked(
          'Learning curves of the cohorts, who is behind the others at the same trial numbers, and who has not come for two weeks to three months.',
        ),
        to: { href: '/cohorts', name: marked('Cohorts') },
      },
      {
        title: marked('Compare two cohorts'),
        text: marked(
          'Choose two cohorts and press Compare. The test is chosen already; the result shows the difference with its interval, its size and every person as a point. It uses the trials of those who agreed to research.',
        ),
        to: { href: '/analysis', name: marked('Analysis') },
      },
      {
        title: marked('Make a rubric'),
        text: marked(
          'Items with points, described at both ends and in the middle, or the global rating scale of OSATS to begin with. Faculty rate trials by it; the agreement of raters is shown beside it.',
        ),
        to: { href: '/ratings/rubrics', name: marked('Rubrics') },
      },
    ],
    terms: [
      kLearning,
      [
        marked('Interval'),
        marked(
          'The range of the true share, given the number of trials (95 %, Wilson). After twelve trials it is still wide.',
        ),
      ],
      [marked('Certified'), marked('Stated only when the number of trials is sufficient.')],
    ],
  },
  {
    role: 'researcher',
    name: marked('Researcher'),
    purpose: marked(
      'Analyse trial data with a locked plan. In the model lab, test the physics of the simulator against measurements.',
    ),
    steps: [
      {
        title: marked('Compare a model with measurements'),
        text: marked(
          'Upload a folder or a zip file, choose a model, and compare. Errors in a file are listed with file name and line.',
        ),
        to: { href: '/lab', name: marked('Model lab') },
      },
      {
        title: marked('Find error regions and missing effects'),
        text: marked(
          'The lab lists the regions with the largest errors and their samples. Then it ranks the effects of the catalogue by the error on held-out trials. The verdict comes first.',
        ),
        picture: {
          name: 'researcher-missing',
          shows: marked('The verdict: the missing effect, and the error at the noise floor after adding it'),
        },
      },
      {
        title: marked('Add the effect'),
        text: marked(
          'Add the recommended effect, choose effects manually, or write a custom formula; its units are checked while you type. Publish the better model as a version. You can compare any two versions and send a version to the stations.',
        ),
        to: { href: '/lab/versions', name: marked('Versions') },
      },
      {
        title: marked('Record your own measurements'),
        text: marked(
          'tractus record reads a force/torque sensor and motion capture; tractus assemble makes a measurement set from them: five taps align the clocks, a recipe aligns the frames. See shared/doc/measuring-room.md for every step.',
        ),
      },
      {
        title: marked('Analyse trial data'),
        text: marked(
          'Lock a plan before you see the data, and run it. Repeated runs give identical results. The published study is included as an example.',
        ),
        to: { href: '/analysis', name: marked('Analysis') },
      },
    ],
    terms: [
      kFloor,
      kHeldOut,
      [
        marked('Confounded'),
        marked(
          'Two effects that these measurements cannot distinguish. The lab recommends the recording that would distinguish them.',
        ),
      ],
      [
        marked('Locked plan'),
        marked('A plan that is stored with its hash, author and time. It can be run, but never changed.'),
      ],
    ],
  },
  {
    role: 'technician',
    name: marked('Technician'),
    purpose: marked('Enrol and maintain the stations that receive cases and upload trials.'),
    steps: [
      {
        title: marked('Enrol a station'),
        text: marked('Enter a name and type the displayed code at the station. Each code can be used once.'),
        to: { href: '/network/stations', name: marked('Stations') },
      },
      {
        title: marked('Test and calibrate'),
        text: marked(
          'At the station, tractus-station self-test checks device, loop, display, disk and clock, and prints a page (--page). tractus-station calibrate determines the zeros of the device under your name. Both results are reported here.',
        ),
      },
      {
        title: marked('Start into the kiosk'),
        text: marked(
          'tractus-station kiosk shows a full-screen page on which trainees sign in with badge and PIN and do their trials; deploy/systemd/tractus-kiosk.service starts it with the machine. It says in words what is wrong: network, device, emergency stop.',
        ),
      },
      {
        title: marked('Check the status'),
        text: marked(
          'Open a station to see its self-tests, when its calibration is due, free disk space and late ticks. Lower its force limit if you suspect a fault of the device; only a person at the station can raise it again.',
        ),
        picture: {
          name: 'technician',
          shows: marked('Backups: created while the server runs, and verified by restoring them'),
        },
      },
      {
        title: marked('Create and verify a backup'),
        text: marked(
          'The server stays in operation while a backup is created. Verification restores the backup to a temporary folder and checks all of it.',
        ),
        to: { href: '/network/backups', name: marked('Backups') },
      },
      {
        title: marked('Revoke a lost station'),
        text: marked('The server refuses its key immediately. Its recordings stay on its disk.'),
      },
    ],
    terms: [
      [
        marked('Self-test'),
        marked(
          'Checks that a station runs: travel, standstill, direction of each axis, step response and round trip of the device; timing, display, disk and clock of the computer.',
        ),
      ],
      [
        marked('Calibration'),
        marked(
          'Determination and check of the zeros of the device, with person and date. It is due again on the date set, or after 90 days.',
        ),
      ],
      [marked('Late ticks'), marked('Ticks of the force loop that start late. Many late ticks can be felt.')],
      [
        marked('Station'),
        marked(
          'A computer with a simulator. It saves trials on its own disk first and uploads them when the server can be reached.',
        ),
      ],
    ],
  },
  {
    role: 'admin',
    name: marked('Administrator'),
    purpose: marked('Manage accounts and roles, and check the audit trail.'),
    steps: [
      {
        title: marked('Create accounts'),
        text: marked('The first password is shown once. It must be changed at the first sign-in.'),
        to: { href: '/network/people', name: marked('Accounts') },
        picture: { name: 'admin', shows: marked('The accounts, with a first password shown once') },
      },
      {
        title: marked('Turn on one-time codes'),
        text: marked('Start with your own account.'),
        to: { href: '/account', name: marked('My account') },
      },
      {
        title: marked('Verify the audit trail'),
        text: marked(
          'Each row contains a hash of all rows before it, so that a change to the audit trail itself is detected.',
        ),
        to: { href: '/network/audit', name: marked('Audit trail') },
      },
      {
        title: marked('Register a learning platform'),
        text: marked(
          'Enter the three addresses of this server at Moodle or Canvas (LTI 1.3), then the addresses of the platform here, and link its people. A link of a course opens an assignment when its custom parameter assignment is the id in the address of the assignment.',
        ),
        to: { href: '/network/mail', name: marked('Mail and webhooks') },
      },
    ],
    terms: [[marked('Role'), marked('What an account may do. The server checks it on every request.')]],
  },
];
