/** What can be asked of the cohort's table, in words, with a formula to begin with. */
export interface Method { readonly id: string; readonly name: string; readonly says: string; readonly formula: (endpoint: string, by: string, person: string) => string; readonly people: boolean }

const plain = (endpoint: string, by: string) => `${endpoint} ~ ${by}`;
const repeated = (endpoint: string, by: string, person: string) => `${endpoint} ~ ${by} + (1|${person})`;

export const kMethods: readonly Method[] = [
  { id: 'lmm', name: 'Linear mixed model', says: 'Trials of the same person go together. The right model for repeated trials.', formula: repeated, people: true },
  { id: 'rm-anova', name: 'Repeated-measures ANOVA', says: 'Every person in every cell, with Greenhouse–Geisser and Huynh–Feldt.', formula: repeated, people: true },
  { id: 'logistic', name: 'Mixed logistic regression', says: 'Right and wrong answers, with the person as a random intercept.', formula: repeated, people: true },
  { id: 'ols', name: 'Linear regression', says: 'As published: every row by itself, which repeated trials are not.', formula: plain, people: false },
  { id: 'robust', name: 'Robust regression', says: 'Linear regression that outliers in the response cannot steer (bisquare).', formula: plain, people: false },
  { id: 'anova', name: 'One-way ANOVA', says: 'As published: groups of independent rows.', formula: plain, people: false },
  { id: 'rank', name: 'Rank tests', says: 'Whether one rises with the other at all, or groups differ in rank.', formula: plain, people: false },
  { id: 'permutation', name: 'Exact permutation test', says: 'For few people: no assumption on the distribution.', formula: plain, people: false },
  { id: 'learning-curve', name: 'Learning curve', says: 'Power and exponential curves over the number of the trial, compared.', formula: repeated, people: true },
  { id: 'describe', name: 'Description', says: 'Mean, spread, normality, and outliers by the modified Z-score.', formula: (endpoint) => `${endpoint} ~ 1`, people: false },
];
