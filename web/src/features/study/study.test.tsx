// @vitest-environment jsdom
import { cleanup, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, beforeAll, describe, expect, it, vi } from 'vitest';
import type { Participant, Slot, Study, StudyTrial } from '@/api';
import { ReasonDialog } from '@/ui';
import { second, utcMicroseconds } from '@/units';
import { People } from './people';
import { statusOf, markOf, eventSentence } from './labels';

afterEach(cleanup);
beforeAll(() => {
  // jsdom has no modal dialogs.
  HTMLDialogElement.prototype.showModal = function () {
    this.open = true;
  };
});

const trial = (changes: Partial<StudyTrial>): StudyTrial => ({
  id: 't1',
  state: 'counts',
  reason: '',
  station: 'lab',
  changed_utc_us: utcMicroseconds(1.7e15),
  started_utc_us: utcMicroseconds(1.7e15),
  duration_s: second(12),
  samples: 12000,
  sha256: 'a',
  assessment: 'assessed',
  correct: true,
  ...changes,
});
const slot = (number: number, changes: Partial<Slot> = {}): Slot => ({
  number,
  state: 'waiting',
  repeat_of: null,
  scenario: null,
  trials: [],
  ...changes,
});
const person = (changes: Partial<Participant>): Participant => ({
  name: 'P01',
  state: 'running',
  level: 'fellow',
  experience_years: 0.5,
  simulated: false,
  at_station: false,
  last_station: null,
  done: 0,
  planned: 2,
  judged: 0,
  recognised: 0,
  slots: [slot(1), slot(2)],
  ...changes,
});
const study = (participants: Participant[]): Study => ({
  id: 's',
  title: 'S',
  state: 'running',
  ordering: 'random',
  repeats: 1,
  on_invalid: 'at_end',
  made_utc_us: utcMicroseconds(1.7e15),
  made_by: 'ada',
  seed: null,
  scenarios: [],
  participants,
});

describe('what a participant is at', () => {
  it.each([
    [person({}), 'not started'],
    [person({ done: 1 }), 'in progress'],
    [person({ at_station: true }), 'at a station'],
    [person({ state: 'paused', at_station: true }), 'paused'],
    [person({ slots: [slot(1, { state: 'recorded' })] }), 'complete'],
    [person({ slots: [slot(1, { state: 'invalid' })] }), 'complete'],
  ] as const)('%#: %s', (who, words) => {
    expect(statusOf(who).text).toBe(words);
  });
});

describe('the sign of a place', () => {
  it('follows the trial that counts', () => {
    const both = [trial({ id: 'a', state: 'invalid', correct: false }), trial({ id: 'b', correct: true })];
    expect(markOf(slot(1, { state: 'recorded', trials: both }))).toBe('right');
    expect(markOf(slot(1, { state: 'recorded', trials: [trial({ correct: null })] }))).toBe('recorded');
    expect(markOf(slot(1, { state: 'invalid', trials: [trial({ state: 'invalid' })] }))).toBe('invalid');
  });
});

it('an event reads as a sentence with its reason', () => {
  expect(
    eventSentence({
      at_utc_us: utcMicroseconds(0),
      who: 'ada',
      what: 'invalid',
      participant: 'P01',
      trial_id: 't',
      reason: 'cable',
    }),
  ).toBe('ada marked a trial of P01 as invalid (cable)');
  expect(
    eventSentence({
      at_utc_us: utcMicroseconds(0),
      who: 'ada',
      what: 'paused',
      participant: null,
      trial_id: null,
      reason: '',
    }),
  ).toBe('ada paused the study');
});

describe('the participants', () => {
  it('show a cell for every place and never which scenario comes', () => {
    render(
      <People
        study={study([
          person({ slots: [slot(1, { state: 'recorded', trials: [trial({ correct: false })] }), slot(2)] }),
        ])}
        ask={vi.fn()}
      />,
    );
    expect(screen.getByRole('link', { name: 'Trial 1: done, not recognised' }).getAttribute('href')).toBe('/trials/t1');
    expect(screen.getByText('2: not started')).toBeTruthy();
  });

  it('open to their trials, each of which can be marked as not counting', async () => {
    const ask = vi.fn();
    render(
      <People study={study([person({ slots: [slot(1, { state: 'recorded', trials: [trial({})] })] })])} ask={ask} />,
    );
    await userEvent.click(screen.getByRole('button', { name: /P01/, expanded: false }));
    const table = screen.getByRole('table', { name: 'Trials of P01' });
    await userEvent.click(within(table).getByRole('button', { name: 'Mark as invalid: trial 1 of P01' }));
    expect(ask).toHaveBeenCalledWith({ kind: 'invalid', participant: 'P01', trial: 't1', number: 1 });
  });

  it('offer no mark on what does not count already', async () => {
    render(
      <People
        study={study([
          person({ slots: [slot(1, { state: 'invalid', trials: [trial({ state: 'invalid', reason: 'cable' })] })] }),
        ])}
        ask={vi.fn()}
      />,
    );
    await userEvent.click(screen.getByRole('button', { name: /P01/, expanded: false }));
    expect(screen.getByText('cable')).toBeTruthy();
    expect(screen.queryByRole('button', { name: /as invalid/ })).toBeNull();
  });
});

describe('the dialog before a action', () => {
  const opened = (onAction: (reason: string) => Promise<void>, onClose = vi.fn()) => {
    render(
      <ReasonDialog title="Pause" text="Really." action="Do it" reasonNeeded onAction={onAction} onClose={onClose} />,
    );
    return onClose;
  };

  it('wants a reason, hands it over and closes', async () => {
    const onAction = vi.fn(() => Promise.resolve());
    const onClose = opened(onAction);
    expect(screen.getByRole<HTMLButtonElement>('button', { name: 'Do it' }).disabled).toBe(true);
    await userEvent.type(screen.getByLabelText('Reason'), ' loose cable ');
    await userEvent.click(screen.getByRole('button', { name: 'Do it' }));
    expect(onAction).toHaveBeenCalledWith('loose cable');
    expect(onClose).toHaveBeenCalled();
  });

  it('stays open and says why when it was refused', async () => {
    const onClose = opened(() => Promise.reject(new Error('it does not count as it is')));
    await userEvent.type(screen.getByLabelText('Reason'), 'x');
    await userEvent.click(screen.getByRole('button', { name: 'Do it' }));
    expect(await screen.findByText('it does not count as it is')).toBeTruthy();
    expect(onClose).not.toHaveBeenCalled();
  });
});
