/** The statistical methods, each with a description and a start formula. */
import { marked } from '@/language';

export interface Method {
  readonly id: string;
  readonly name: string;
  readonly description: string;
  readonly formula: (endpoint: string, by: string, person: string) => string;
  readonly people: boolean;
}

const plain = (endpoint: string, by: string) => `${endpoint} ~ ${by}`;
const repeated = (endpoint: string, by: string, person: string) => `${endpoint} ~ ${by} + (1|${person})`;

export const kMethods: readonly Method[] = [
  {
    id: 'lmm',
    name: marked('Linear mixed model'),
    description: marked('Accounts for repeated trials by the same person. Recommended when trials repeat.'),
    formula: repeated,
    people: true,
  },
  {
    id: 'rm-anova',
    name: marked('Repeated-measures ANOVA'),
    description: marked('Needs every person in every condition. Corrected by Greenhouse–Geisser and Huynh–Feldt.'),
    formula: repeated,
    people: true,
  },
  {
    id: 'logistic',
    name: marked('Mixed logistic regression'),
    description: marked('For correct or incorrect answers, with a random intercept per person.'),
    formula: repeated,
    people: true,
  },
  {
    id: 'ols',
    name: marked('Linear regression'),
    description: marked(
      'As in the published study: treats all trials as independent, which repeated trials by one person are not.',
    ),
    formula: plain,
    people: false,
  },
  {
    id: 'robust',
    name: marked('Robust regression'),
    description: marked('Linear regression that limits the influence of outliers in the response (bisquare weights).'),
    formula: plain,
    people: false,
  },
  {
    id: 'anova',
    name: marked('One-way ANOVA'),
    description: marked('As in the published study: compares groups of independent trials.'),
    formula: plain,
    people: false,
  },
  {
    id: 'effect-size',
    name: marked('Difference of two groups'),
    description: marked(
      'Two groups of persons, each counted once by the mean of their trials: difference, Hedges’ g, interval.',
    ),
    formula: repeated,
    people: true,
  },
  {
    id: 'rank',
    name: marked('Rank tests'),
    description: marked('Tests whether two variables rise together, or whether groups differ in rank.'),
    formula: plain,
    people: false,
  },
  {
    id: 'permutation',
    name: marked('Exact permutation test'),
    description: marked('For small samples: makes no assumption about the distribution.'),
    formula: plain,
    people: false,
  },
  {
    id: 'learning-curve',
    name: marked('Learning curve'),
    description: marked('Fits power and exponential curves over the trial number and compares them.'),
    formula: repeated,
    people: true,
  },
  {
    id: 'describe',
    name: marked('Descriptive statistics'),
    description: marked('Mean, standard deviation, normality, and outliers by the modified Z-score.'),
    formula: (endpoint) => `${endpoint} ~ 1`,
    people: false,
  },
];
