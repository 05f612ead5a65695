/** The guide's first week: what a residency does from the list of residents to the first comparison. The pictures are made by the tests. */
import { marked } from '@/language';
import type { Step } from './pages';

const shown = (name: string, shows: string) => ({ picture: { name: `week-${name}`, shows } });

export interface Day {
  readonly name: string;
  readonly steps: readonly Step[];
}

export const kFirstWeek: readonly Day[] = [
  {
    name: marked('Monday: the class and what passing is'),
    steps: [
      {
        title: marked('The director imports the residents'),
        text: marked(
          'The list comes from a spreadsheet. Every row is checked first; while a row has an error, no account is created. The residents join a new cohort.',
        ),
        to: { href: '/class', name: marked('Class') },
        ...shown('import', marked('The list of 24 residents, checked row by row: 24 rows, no errors')),
      },
      {
        title: marked('Sign-in cards are printed'),
        text: marked('Each card has a code that opens the sign-in, and a password that works once.'),
        ...shown('cards', marked('Sign-in cards with name, code, first password and badge')),
      },
      {
        title: marked('A bound is taken from experts'),
        text: marked(
          'Three experts have done the same cases. The bound is their mean and two standard deviations; the picture shows a dot for each trial.',
        ),
        to: { href: '/curricula', name: marked('Curricula') },
        ...shown(
          'bound',
          marked('A requirement of a step: the probing times of three experts, and the bound beside them'),
        ),
      },
      {
        title: marked('The curriculum is given to the class'),
        text: marked(
          'Two steps; the second opens when the first is passed. A change makes a new version, and whoever has begun keeps the earlier one.',
        ),
        ...shown('curriculum', marked('The curriculum with its steps, and where each resident stands')),
      },
    ],
  },
  {
    name: marked('Tuesday: the kiosks'),
    steps: [
      {
        title: marked('A resident signs in with badge and PIN'),
        text: marked(
          'The kiosk shows the next trial and how to hold the probe. The trial starts by a touch, or by the button of the device.',
        ),
        ...shown('kiosk-work', marked('The kiosk: the next trial with its instructions and the button Start')),
      },
      {
        title: marked('The network fails during the trial'),
        text: marked('The trial goes on. A blind trial shows the time, and no depth.'),
        ...shown('kiosk-running', marked('The kiosk during a trial')),
      },
      {
        title: marked('The trial is kept at the station'),
        text: marked(
          'After the answer the kiosk says that the server does not answer and that the trial is safe. Once the network is back, it is sent by itself.',
        ),
        ...shown('kiosk-offline', marked('The kiosk: trial done, safe at this station and sent later')),
      },
      {
        title: marked('A station loses its power'),
        text: marked('When it runs again, it says what was recorded until then. The next person signs in and goes on.'),
        ...shown('kiosk-interrupted', marked('The kiosk after a trial was interrupted')),
      },
    ],
  },
  {
    name: marked('Wednesday: debriefing'),
    steps: [
      {
        title: marked('Faculty debriefs the trial'),
        text: marked('Faculty and resident replay the trial together. A comment is kept at a moment of the trial.'),
        to: { href: '/trials', name: marked('Trials') },
        ...shown('debrief', marked('The debriefing of a trial: replay, charts and a comment')),
      },
      {
        title: marked('Two people rate it'),
        text: marked(
          'The form is the programme’s own. The trainee’s name is hidden and neither rater sees the other’s points until both have rated.',
        ),
        to: { href: '/ratings', name: marked('Ratings') },
        ...shown('rating', marked('The form for a rating: items with points from 1 to 5')),
      },
    ],
  },
  {
    name: marked('Thursday: who has passed'),
    steps: [
      {
        title: marked('One resident passes'),
        text: marked('The page of the curriculum shows the state of every step of everybody.'),
        ...shown('progress', marked('The curriculum: one resident has passed both steps')),
      },
      {
        title: marked('The certificate is printed'),
        text: marked(
          'One sheet. It states each requirement with what was found, the number of trials, and a digest by which the records can be found.',
        ),
        ...shown('certificate', marked('The certificate as it is printed')),
      },
      {
        title: marked('Another trainee relapses, and recovers'),
        text: marked(
          'The chart counts wrong answers after competence was signalled. The relapse ends when its sum is back at zero; the chart has the date.',
        ),
        to: { href: '/trainees', name: marked('Trainees') },
        ...shown('relapse', marked('A trainee’s page: competence, a relapse, and its end')),
      },
    ],
  },
  {
    name: marked('Friday: the cohort'),
    steps: [
      {
        title: marked('The cohorts side by side'),
        text: marked('Learning curves by running trial number, who is behind, and who has not come.'),
        to: { href: '/cohorts', name: marked('Cohorts') },
        ...shown('cohorts', marked('Learning curves of the cohorts')),
      },
      {
        title: marked('Two cohorts are compared'),
        text: marked(
          'Choose two cohorts and a measure. Each person counts once, by the mean of their trials; the size of the difference has its interval.',
        ),
        to: { href: '/analysis', name: marked('Analysis') },
        ...shown('compare', marked('The result: the difference of two cohorts with its interval')),
      },
    ],
  },
];
