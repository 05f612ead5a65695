import { hearing, marked } from '@/language';

/** Requirements, and what trials show of them, as the server writes them (shared/assessment: criteria.cpp, trainee_report.cpp). */
export const heard = hearing([
  marked('{metric} at most {bound} in {times} of trials'),
  marked('{metric} at least {bound} in {times} of trials'),
  marked('{metric} at most {bound} in {times} of the last {last} trials'),
  marked('{metric} at least {bound} in {times} of the last {last} trials'),
  marked('Correct answers at least {share} % at the low end of the {level} % interval, of all answers'),
  marked('Correct answers at least {share} % at the low end of the {level} % interval, of the last {last} answers'),
  marked('Competence by LC-CUSUM: failure rate {adequate} % acceptable, {inadequate} % unacceptable'),
  marked('{right} of {answers} right, low end {low} %'),
  marked('no answer yet'),
  marked('competent at trial {trial}, relapsed at trial {relapse}'),
  marked('no signal of competence in {trials} trials'),
  marked('signal at trial {trial}'),
  marked('relapsed at trial {relapse}, recovered at trial {end}'),
  marked(
    'somebody who fails {rate} % reaches h = {threshold} within {trials} trials with a chance of {chance}, more than {risk}',
  ),
  marked('somebody who fails {rate} % reaches h = {threshold} within {trials} trials with a chance of {chance}'),
  marked(
    '{trials} trials are too few to certify anybody: {needed} are needed (h = {threshold}: passed by {adequate} % of those who fail {adequateRate} %, by {inadequate} % of those who fail {inadequateRate} %)',
  ),
  marked('a laxer h = 1.25 would pass {share} % of the latter within {trials} trials'),
  marked(
    'no number of trials up to 400 tells failure rates of {adequate} % and {inadequate} % apart well enough to certify',
  ),
  marked(
    '{right} of {trials} right so far: the failure rate may be as high as {rate} % (90 % point), higher than of any other scenario',
  ),
  marked('{kept} of {count}'),
]);
