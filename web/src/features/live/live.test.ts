import { describe, expect, it } from 'vitest';
import * as v from 'valibot';
import type { StationState } from '@/api';
import { liveMessageSchema } from '@/api/live-schemas';
import { withMessage } from './use-live';
import { byUrgency, summaryOf } from './station-states';

const station = (name: string, state: StationState['state']) =>
  v.parse(liveMessageSchema, { kind: 'station', station: { id: name, name, state, connected: state !== 'away' } }) as {
    kind: 'station';
    station: StationState;
  };
const of = (name: string, state: StationState['state']) => station(name, state).station;

describe('the live view', () => {
  it('puts first where a person is needed', () => {
    const order = byUrgency([of('b', 'idle'), of('a', 'away'), of('d', 'trial'), of('c', 'fault'), of('e', 'stopped')]);
    expect(order.map(({ name }) => name)).toEqual(['c', 'e', 'd', 'b', 'a']);
  });

  it('says in one line what the colours say', () => {
    expect(summaryOf([of('a', 'trial'), of('b', 'questions'), of('c', 'fault'), of('d', 'idle')])).toBe(
      '2 in use, 1 needing attention, 1 available',
    );
    expect(summaryOf([])).toBe('no stations');
  });

  it('takes in one station that changed, and one that is new', () => {
    const first = withMessage(null, { kind: 'stations', stations: [of('a', 'idle'), of('b', 'idle')] });
    const changed = withMessage(first, station('b', 'trial'));
    expect(changed.map(({ state }) => state)).toEqual(['idle', 'trial']);
    expect(withMessage(changed, station('c', 'idle'))).toHaveLength(3);
  });

  it('holds a station of which nothing is known for one that is away', () => {
    const { station: known } = v.parse(liveMessageSchema, { kind: 'station', station: { id: 'x', name: 'x' } }) as {
      station: StationState;
    };
    expect(known).toMatchObject({ state: 'away', connected: false, trial: null, self_test: null });
  });
});
