/** The guide: purpose, steps and terms, one page per role. */

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
  'Simulated',
  'Recorded by a program, not by a person. Simulated trials are marked on every page.',
] as const;
const kFloor = [
  'Noise floor',
  'The error that noise alone causes, estimated from the measurements themselves.',
] as const;
const kHeldOut = [
  'Held-out trials',
  'Trials that a fit did not use. The error on them estimates the error on the next recording.',
] as const;
const kLearning = [
  'LC-CUSUM',
  'A running sum over the trials: correct answers increase it, incorrect answers decrease it. When it reaches the threshold, competence is signalled; from then on, a second sum detects relapse.',
] as const;

export const kPages: readonly GuidePage[] = [
  {
    role: 'trainee',
    name: 'Trainee',
    purpose: 'Do your assigned trials, blinded, and follow your own progress.',
    steps: [
      {
        title: 'See your assignments',
        text: 'Your assignments, your progress in each, and the due dates.',
        to: { href: '/assignments', name: 'My work' },
      },
      {
        title: 'Sign in at a station',
        text: 'Use your badge number and PIN. The station offers your next trial. Neither the station nor the files on its disk reveal the kind of bone.',
      },
      {
        title: 'Palpate or probe, then answer',
        text: 'Is there a breach, where, and how confident are you? Your answer ends the trial. In cases without a pre-drilled channel, you first drill the channel; the station then lets you palpate it.',
      },
      {
        title: 'See your progress',
        text: 'After the results are released: correct answers over the trials, your strengths, and whether your confidence matches your accuracy.',
        to: { href: '/me', name: 'My progress' },
        picture: { name: 'trainee', shows: 'The page of a trainee: summary, learning, competence, confidence' },
      },
    ],
    terms: [
      ['Breach', 'A place where the channel leaves the bone.'],
      kLearning,
      [
        'Confidence',
        'How sure you are of your answer. On the diagonal of the chart, 80 % of the answers with a confidence of 80 % are correct.',
      ],
    ],
  },
  {
    role: 'faculty',
    name: 'Faculty',
    purpose: 'Create cases, assign them, supervise, debrief, and release results.',
    steps: [
      {
        title: 'Create a cohort',
        text: 'Enter a name and add trainees by account name. Removing a trainee can be undone.',
        to: { href: '/network/cohorts', name: 'Cohorts' },
      },
      {
        title: 'Upload a volume',
        text: 'A folder or a zip of one DICOM series, or a NIfTI or NRRD file. The server takes the patient’s identity out; a director or an administrator looks at the slices and releases the volume.',
        to: { href: '/volumes', name: 'Volumes' },
      },
      {
        title: 'Create a case',
        text: 'Place the entry and the target of the tract in the slices of a CT. Choose the breached wall and the depth of the breach; the page shows the position of the breach and the thickness of the wall. Alternatively, let the trainee drill the channel and then palpate it. For the probing rig, define the layers and walls of a scenario.',
        to: { href: '/cases', name: 'Cases' },
      },
      {
        title: 'Check what can be felt',
        text: 'The page says for each wall whether a breach can be felt, and where best. With filled bone, the dashed outline in the slices is the outer face of the vertebra that was found: where it is wrong, paint “Bone here” or “No bone here”. Move the entry or the target until every wall can be felt.',
        to: { href: '/cases', name: 'Cases' },
      },
      {
        title: 'Assign the case',
        text: 'Choose a cohort or individual trainees, repeats, order and due date. Each trainee gets an individual, blinded order. Results stay hidden until you release them.',
        to: { href: '/assignments', name: 'Assignments' },
      },
      {
        title: 'Supervise the stations',
        text: 'See who is in a trial, for how long and with which force. Stations that need attention are listed first. Stop a trial with a reason.',
        to: { href: '/wall', name: 'Live stations' },
      },
      {
        title: 'Debrief a trial',
        text: 'Replay the trial: path of the tip in 3-D, forces, touched walls, force against depth, and an example trial as a ghost. When you point at a time in one chart, all others follow. You can add a comment at that time.',
        to: { href: '/trials', name: 'Trials' },
        picture: { name: 'faculty', shows: 'A palpation trial: signals, path of the tip in 3-D, touched walls' },
      },
      {
        title: 'Rate a trial',
        text: 'In the debriefing, have a trial rated by a rubric, by how many people, and whether the trainee’s name is hidden until all have rated. Nobody sees another’s rating before that. A submitted rating cannot be changed, only superseded with a reason.',
        to: { href: '/ratings', name: 'Ratings' },
      },
    ],
    terms: [
      ['Walls touched', 'The unrolled wall of the tract, with the share of each side that the tip touched.'],
      ['Scenario', 'The bone of a probing trial: its layers and the walls that are breached.'],
      kSimulated,
    ],
  },
  {
    role: 'director',
    name: 'Programme director',
    purpose: 'See which trainees are on track, have relapsed, or are inactive.',
    steps: [
      {
        title: 'Open the list of trainees',
        text: 'Filter it by trainees who have relapsed, are learning, or have had no trial for two months.',
        to: { href: '/trainees', name: 'Trainees' },
        picture: {
          name: 'director',
          shows: 'The list of trainees with state, share of correct answers and last trial',
        },
      },
      {
        title: 'Open one trainee',
        text: 'One page shows the summary, learning, competence, recognition by scenario, and confidence.',
      },
      { title: 'Print the page', text: '“Print this page” prints one sheet for the interview.' },
      {
        title: 'Look at whole cohorts',
        text: 'Learning curves of the cohorts, who is behind the others at the same trial numbers, and who has not come for two weeks to three months.',
        to: { href: '/cohorts', name: 'Cohorts' },
      },
      {
        title: 'Compare two cohorts',
        text: 'Choose two cohorts and press Compare. The test is chosen already; the result shows the difference with its interval, its size and every person as a point. It uses the trials of those who agreed to research.',
        to: { href: '/analysis', name: 'Analysis' },
      },
      {
        title: 'Make a rubric',
        text: 'Items with points, described at both ends and in the middle, or the global rating scale of OSATS to begin with. Faculty rate trials by it; the agreement of raters is shown beside it.',
        to: { href: '/ratings/rubrics', name: 'Rubrics' },
      },
    ],
    terms: [
      kLearning,
      [
        'Interval',
        'The range of the true share, given the number of trials (95 %, Wilson). After twelve trials it is still wide.',
      ],
      ['Certified', 'Stated only when the number of trials is sufficient.'],
    ],
  },
  {
    role: 'researcher',
    name: 'Researcher',
    purpose:
      'Analyse trial data with a locked plan. In the model lab, test the physics of the simulator against measurements.',
    steps: [
      {
        title: 'Compare a model with measurements',
        text: 'Upload a folder or a zip file, choose a model, and compare. Errors in a file are listed with file name and line.',
        to: { href: '/lab', name: 'Model lab' },
      },
      {
        title: 'Find error regions and missing effects',
        text: 'The lab lists the regions with the largest errors and their samples. Then it ranks the effects of the catalogue by the error on held-out trials. The verdict comes first.',
        picture: {
          name: 'researcher-missing',
          shows: 'The verdict: the missing effect, and the error at the noise floor after adding it',
        },
      },
      {
        title: 'Add the effect',
        text: 'Add the recommended effect, choose effects manually, or write a custom formula; its units are checked while you type. Publish the better model as a version. You can compare any two versions and send a version to the stations.',
        to: { href: '/lab/versions', name: 'Versions' },
      },
      {
        title: 'Record your own measurements',
        text: 'tractus record reads a force/torque sensor and motion capture; tractus assemble makes a measurement set from them: five taps align the clocks, a recipe aligns the frames. See shared/doc/measuring-room.md for every step.',
      },
      {
        title: 'Analyse trial data',
        text: 'Lock a plan before you see the data, and run it. Repeated runs give identical results. The published study is included as an example.',
        to: { href: '/analysis', name: 'Analysis' },
      },
    ],
    terms: [
      kFloor,
      kHeldOut,
      [
        'Confounded',
        'Two effects that these measurements cannot distinguish. The lab recommends the recording that would distinguish them.',
      ],
      ['Locked plan', 'A plan that is stored with its hash, author and time. It can be run, but never changed.'],
    ],
  },
  {
    role: 'technician',
    name: 'Technician',
    purpose: 'Enrol and maintain the stations that receive cases and upload trials.',
    steps: [
      {
        title: 'Enrol a station',
        text: 'Enter a name and type the displayed code at the station. Each code can be used once.',
        to: { href: '/network/stations', name: 'Stations' },
      },
      {
        title: 'Test and calibrate',
        text: 'At the station, tractus-station self-test checks device, loop, display, disk and clock, and prints a page (--page). tractus-station calibrate determines the zeros of the device under your name. Both results are reported here.',
      },
      {
        title: 'Start into the kiosk',
        text: 'tractus-station kiosk shows a full-screen page on which trainees sign in with badge and PIN and do their trials; deploy/systemd/tractus-kiosk.service starts it with the machine. It says in words what is wrong: network, device, emergency stop.',
      },
      {
        title: 'Check the status',
        text: 'Open a station to see its self-tests, when its calibration is due, free disk space and late ticks. Lower its force limit if you suspect a fault of the device; only a person at the station can raise it again.',
        picture: {
          name: 'technician',
          shows: 'Backups: created while the server runs, and verified by restoring them',
        },
      },
      {
        title: 'Create and verify a backup',
        text: 'The server stays in operation while a backup is created. Verification restores the backup to a temporary folder and checks all of it.',
        to: { href: '/network/backups', name: 'Backups' },
      },
      {
        title: 'Revoke a lost station',
        text: 'The server refuses its key immediately. Its recordings stay on its disk.',
      },
    ],
    terms: [
      [
        'Self-test',
        'Checks that a station runs: travel, standstill, direction of each axis, step response and round trip of the device; timing, display, disk and clock of the computer.',
      ],
      [
        'Calibration',
        'Determination and check of the zeros of the device, with person and date. It is due again on the date set, or after 90 days.',
      ],
      ['Late ticks', 'Ticks of the force loop that start late. Many late ticks can be felt.'],
      [
        'Station',
        'A computer with a simulator. It saves trials on its own disk first and uploads them when the server can be reached.',
      ],
    ],
  },
  {
    role: 'admin',
    name: 'Administrator',
    purpose: 'Manage accounts and roles, and check the audit trail.',
    steps: [
      {
        title: 'Create accounts',
        text: 'The first password is shown once. It must be changed at the first sign-in.',
        to: { href: '/network/people', name: 'Accounts' },
        picture: { name: 'admin', shows: 'The accounts, with a first password shown once' },
      },
      {
        title: 'Turn on one-time codes',
        text: 'Start with your own account.',
        to: { href: '/account', name: 'My account' },
      },
      {
        title: 'Verify the audit trail',
        text: 'Each row contains a hash of all rows before it, so that a change to the audit trail itself is detected.',
        to: { href: '/network/audit', name: 'Audit trail' },
      },
    ],
    terms: [['Role', 'What an account may do. The server checks it on every request.']],
  },
];
