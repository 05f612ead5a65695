/** The guide's first week: what a residency does from the list of residents to the first comparison. The pictures are made by the tests. */
import type { Step } from './pages';

const shown = (name: string, shows: string) => ({ picture: { name: `week-${name}`, shows } });

export interface Day {
  readonly name: string;
  readonly steps: readonly Step[];
}

export const kFirstWeek: readonly Day[] = [
  {
    name: 'Monday: the class and what passing is',
    steps: [
      {
        title: 'The director imports the residents',
        text: 'The list comes from a spreadsheet. Every row is checked first; while a row has an error, no account is created. The residents join a new cohort.',
        to: { href: '/class', name: 'Class' },
        ...shown('import', 'The list of 24 residents, checked row by row: 24 rows, no errors'),
      },
      {
        title: 'Sign-in cards are printed',
        text: 'Each card has a code that opens the sign-in, and a password that works once.',
        ...shown('cards', 'Sign-in cards with name, code, first password and badge'),
      },
      {
        title: 'A bound is taken from experts',
        text: 'Three experts have done the same cases. The bound is their mean and two standard deviations; the picture shows a dot for each trial.',
        to: { href: '/curricula', name: 'Curricula' },
        ...shown('bound', 'A requirement of a step: the probing times of three experts, and the bound beside them'),
      },
      {
        title: 'The curriculum is given to the class',
        text: 'Two steps; the second opens when the first is passed. A change makes a new version, and whoever has begun keeps the earlier one.',
        ...shown('curriculum', 'The curriculum with its steps, and where each resident stands'),
      },
    ],
  },
  {
    name: 'Tuesday: the kiosks',
    steps: [
      {
        title: 'A resident signs in with badge and PIN',
        text: 'The kiosk shows the next trial and how to hold the probe. The trial starts by a touch, or by the button of the device.',
        ...shown('kiosk-work', 'The kiosk: the next trial with its instructions and the button Start'),
      },
      {
        title: 'The network fails during the trial',
        text: 'The trial goes on. A blind trial shows the time, and no depth.',
        ...shown('kiosk-running', 'The kiosk during a trial'),
      },
      {
        title: 'The trial is kept at the station',
        text: 'After the answer the kiosk says that the server does not answer and that the trial is safe. Once the network is back, it is sent by itself.',
        ...shown('kiosk-offline', 'The kiosk: trial done, safe at this station and sent later'),
      },
      {
        title: 'A station loses its power',
        text: 'When it runs again, it says what was recorded until then. The next person signs in and goes on.',
        ...shown('kiosk-interrupted', 'The kiosk after a trial was interrupted'),
      },
    ],
  },
  {
    name: 'Wednesday: debriefing',
    steps: [
      {
        title: 'Faculty debriefs the trial',
        text: 'Faculty and resident replay the trial together. A comment is kept at a moment of the trial.',
        to: { href: '/trials', name: 'Trials' },
        ...shown('debrief', 'The debriefing of a trial: replay, charts and a comment'),
      },
      {
        title: 'Two people rate it',
        text: 'The form is the programme’s own. The trainee’s name is hidden and neither rater sees the other’s points until both have rated.',
        to: { href: '/ratings', name: 'Ratings' },
        ...shown('rating', 'The form for a rating: items with points from 1 to 5'),
      },
    ],
  },
  {
    name: 'Thursday: who has passed',
    steps: [
      {
        title: 'One resident passes',
        text: 'The page of the curriculum shows the state of every step of everybody.',
        ...shown('progress', 'The curriculum: one resident has passed both steps'),
      },
      {
        title: 'The certificate is printed',
        text: 'One sheet. It states each requirement with what was found, the number of trials, and a digest by which the records can be found.',
        ...shown('certificate', 'The certificate as it is printed'),
      },
      {
        title: 'Another trainee relapses, and recovers',
        text: 'The chart counts wrong answers after competence was signalled. The relapse ends when its sum is back at zero; the chart has the date.',
        to: { href: '/trainees', name: 'Trainees' },
        ...shown('relapse', 'A trainee’s page: competence, a relapse, and its end'),
      },
    ],
  },
  {
    name: 'Friday: the cohort',
    steps: [
      {
        title: 'The cohorts side by side',
        text: 'Learning curves by running trial number, who is behind, and who has not come.',
        to: { href: '/cohorts', name: 'Cohorts' },
        ...shown('cohorts', 'Learning curves of the cohorts'),
      },
      {
        title: 'Two cohorts are compared',
        text: 'Choose two cohorts and a measure. Each person counts once, by the mean of their trials; the size of the difference has its interval.',
        to: { href: '/analysis', name: 'Analysis' },
        ...shown('compare', 'The result: the difference of two cohorts with its interval'),
      },
    ],
  },
];
