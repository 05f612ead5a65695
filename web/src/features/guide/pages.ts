/** What each role comes for and how it is done, in order; a page a role. */

/** Made by the tests on a real server (GUIDE_PICTURES=1), so that it shows what is there. */
export interface Picture { readonly name: string; readonly shows: string }
export interface Step { readonly title: string; readonly text: string; readonly to?: { readonly href: string; readonly name: string }; readonly picture?: Picture }
export interface GuidePage { readonly role: string; readonly name: string; readonly for: string; readonly steps: readonly Step[]; readonly terms: readonly (readonly [string, string])[] }

const kSimulated = ['Simulated', 'Made by a machine, not by a hand. It is marked so wherever it is shown.'] as const;
const kFloor = ['Noise floor', 'The error that noise alone leaves, estimated from the measurements themselves.'] as const;
const kHeldOut = ['Held out', 'Trials that a fit did not see: the error on them is what a model is worth on the next recording.'] as const;
const kLearning = ['LC-CUSUM', 'A running sum over the trials: right answers add, wrong ones take off. At the threshold competence is signalled; from then on a second sum watches for relapse.'] as const;

export const kPages: readonly GuidePage[] = [
  {
    role: 'trainee', name: 'Trainee', for: 'Do the trials that are assigned to you, blind, and see your own curve.',
    steps: [
      { title: 'See what waits for you', text: 'What is assigned, how far you are, until when.', to: { href: '/assignments', name: 'My work' } },
      { title: 'Sign in at a station', text: 'With your badge number and PIN. The station gives you exactly the next trial; what kind of bone it is nobody tells you, not even the files on the station’s disk.' },
      { title: 'Palpate or probe, then answer', text: 'Was there a breach, where, and how sure are you? The answer ends the trial. Where the bone is whole you drill the channel first, with nothing to answer; the station then lets you feel the one that you made.' },
      { title: 'See your curve', text: 'Once results are released: right answers over the trials, what you are strong in, and whether your confidence is worth what it says.', to: { href: '/me', name: 'My curve' }, picture: { name: 'trainee', shows: 'A trainee’s own page: standing, learning, competence, confidence' } },
    ],
    terms: [['Breach', 'A place where the channel has left the bone.'], kLearning, ['Confidence', 'How sure you said to be. On the diagonal of its picture, of answers given 80 % sure 80 % are right.']],
  },
  {
    role: 'faculty', name: 'Faculty', for: 'Make cases, assign them, watch, debrief, release results.',
    steps: [
      { title: 'Gather a cohort', text: 'Give it a name, add trainees by the names of their accounts. Taking somebody out can be undone.', to: { href: '/network/cohorts', name: 'Cohorts' } },
      { title: 'Make a case', text: 'Place entry and target of the tract in the slices of a CT, choose which wall gives way and how deep; you see at once where it does and how thin it is there. Or leave the bone whole: whoever is assigned it drills the channel, then feels it. Or write the layers and walls of a probing scenario.', to: { href: '/cases', name: 'Cases' } },
      { title: 'Assign it', text: 'To a cohort or to people, with repeats, order and a date. Everybody gets an order of their own, blind. Results stay held until you release them.', to: { href: '/assignments', name: 'Assignments' } },
      { title: 'Watch the stations', text: 'Who is at work, for how long, with which force; where somebody is needed stands first. Stop one that goes wrong, with a reason.', to: { href: '/wall', name: 'Stations live' } },
      { title: 'Debrief a trial', text: 'Play it back: the way of the tip in 3-D, forces, which walls were touched, force against depth, an expert’s trial beside it as a ghost. Point at a moment in one picture and all others follow; leave a comment at it.', to: { href: '/trials', name: 'Trials' }, picture: { name: 'faculty', shows: 'A palpation trial: signals, the way of the tip in 3-D, the walls that were touched' } },
    ],
    terms: [['Walls touched', 'The wall of the tract unrolled, with the share of each side that the tip has felt.'], ['Scenario', 'The bone of a probing trial: its layers, and the walls that give way.'], kSimulated],
  },
  {
    role: 'director', name: 'Programme director', for: 'Who is on track, who has relapsed, who is due.',
    steps: [
      { title: 'Look at the list', text: 'Narrow it to who has relapsed, who is learning, who has not been at a station for two months.', to: { href: '/trainees', name: 'Trainees' }, picture: { name: 'director', shows: 'The list of trainees with state, share right and last trial' } },
      { title: 'Open one trainee', text: 'Standing, learning, competence, recognition by scenario, confidence, on one page.' },
      { title: 'Print it', text: '“Print this page” makes one sheet for the interview.' },
    ],
    terms: [kLearning, ['Interval', 'Where the true share may lie, given so few trials (95 %, Wilson). It is wide after twelve trials, and the page says so.'], ['Certified', 'Said only when the trials are enough to say it of anybody.']],
  },
  {
    role: 'researcher', name: 'Researcher', for: 'Cohort data with a locked plan; and the model lab: is the simulator’s physics true, where not, what is missing.',
    steps: [
      { title: 'Hold a model against measurements', text: 'Drop a folder or a zip, choose a model, compare. What is wrong in a file is told by its name and line.', to: { href: '/lab', name: 'Model lab' } },
      { title: 'See where it fails, and what is missing', text: 'A short list of regions with their samples; then the effects of the catalogue, ranked by the error on trials that no fit saw. The verdict stands first, in plain words.', picture: { name: 'researcher-missing', shows: 'The verdict: which effect is missing, and the error falling to the noise floor' } },
      { title: 'Add it, and watch the error fall', text: 'By one press, by hand, or by a formula of your own whose units are checked while you write. Publish the better model as a version; any two versions can be compared, and a version sent to the stations can be felt there minutes later.', to: { href: '/lab/versions', name: 'Versions' } },
      { title: 'Bring measurements of your own', text: 'tractus record takes a force/torque sensor and motion capture, tractus assemble makes a set of them: clocks made one by five taps, frames by a recipe. How, step by step, is in shared/doc/measuring-room.md.' },
      { title: 'Ask the cohort', text: 'Lock a plan before the data are seen, run it, run it again to the same digits. The published study is there as an example.', to: { href: '/analysis', name: 'Analysis' } },
    ],
    terms: [kFloor, kHeldOut, ['Confounded', 'Two effects that look alike in these measurements. The lab names the recording that would tell them apart.'], ['Locked plan', 'Every word of it has its hash taken, with name and time. It can be run and never changed.']],
  },
  {
    role: 'technician', name: 'Technician', for: 'Stations that may fetch cases and bring trials.',
    steps: [
      { title: 'Enrol a station', text: 'Give it a name, type the code that is shown at the station. The code is good once.', to: { href: '/network/stations', name: 'Stations' } },
      { title: 'Test and calibrate', text: 'At the station: tractus-station self-test asks device, loop, display, disk and clock, check by check, and prints a page (--page); tractus-station calibrate finds the device’s zeros, under your name. Both are told here.' },
      { title: 'See how each is', text: 'Open a station: its self-tests check by check, when its calibration is due, room on its disk, late steps. Lower its force limit when you doubt the device; only a person at the station raises it again.', picture: { name: 'technician', shows: 'Backups: made while the server serves, and tried by restoring them' } },
      { title: 'Make a backup, and try it', text: 'It is made while everything goes on. Trying it restores it beside and looks everything over: only then is it worth something.', to: { href: '/network/backups', name: 'Backups' } },
      { title: 'Revoke one that is lost', text: 'Its key is refused at once; what it has recorded stays on its disk.' },
    ],
    terms: [['Self-test', 'What a station asks of itself: travel, rest, direction of every axis, step response and round trip of its device; wake-ups, display, disk and clock of the machine.'], ['Calibration', 'The device’s zeros found anew and checked, by whom and when; due again on the date that was set, 90 days later if none was.'], ['Late steps', 'Steps of the force loop that came later than they should have. The hand feels them when there are many.'], ['Station', 'A machine with a simulator. It records to its own disk first and hands over when it can.']],
  },
  {
    role: 'admin', name: 'Administrator', for: 'Accounts, roles, and the record of every change.',
    steps: [
      { title: 'Make accounts', text: 'A first password is made and shown once; it has to be changed at the first sign-in.', to: { href: '/network/people', name: 'Accounts' }, picture: { name: 'admin', shows: 'The accounts, with a first password shown once' } },
      { title: 'Turn on one-time codes', text: 'For your own account first.', to: { href: '/account', name: 'My account' } },
      { title: 'Check the audit trail', text: 'Each row carries a hash of all rows before it, so that a change to the record itself shows.', to: { href: '/network/audit', name: 'Audit trail' } },
    ],
    terms: [['Role', 'What an account may do. The server decides it anew on every call.']],
  },
];
