/** A researcher's blind study at a kiosk: pseudonyms without a PIN, no depth, no result, on without the server, and nothing that tells the scenario. */
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { accessibilityFaults } from '../axe';
import { kShots, launch } from '../browser';
import { KioskPerson } from '../kiosk-person';
import { Line, startKiosk, type Kiosk } from '../kiosk-station';
import { furnish, Person, scored, type Programme } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus', 'tractus-server', 'tractus-station') ?? '';
const kStudy = 'blind-bone',
  kParticipant = 'P01',
  kPerson = 'P02';

interface Study {
  readonly done: number;
  readonly participants: readonly {
    name: string;
    slots: readonly {
      state: string;
      scenario: string | null;
      trials: readonly { id: string; correct: boolean | null }[];
    }[];
  }[];
}

function files(folder: string): string[] {
  return readdirSync(folder).flatMap((name) => {
    const path = join(folder, name);
    return statSync(path).isDirectory() ? files(path) : [path];
  });
}

describe.skipIf(bin === '')('a blind study at the kiosk', () => {
  let browser: Browser, served: Served, programme: Programme, line: Line, kiosk: Kiosk, researcher: Person;
  const seen: string[] = [];
  const slots = async () => {
    const study = await researcher.ask<Study>('GET', `/studies/${kStudy}`);
    return study.participants.find(({ name }) => name === kParticipant)?.slots ?? [];
  };
  const recorded = async () => (await slots()).filter(({ state }) => state === 'recorded').length;
  const look = async (person: KioskPerson, name: string) => {
    await person.page.screenshot({ path: `${kShots}kiosk-study-${name}.png` });
    expect(await accessibilityFaults(person.page), name).toEqual([]);
    seen.push(await person.page.content());
  };

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin);
    programme = await furnish(served, bin);
    line = await Line.to(served.url);
    researcher = await new Person(served.url).in('researcher', programme.passwords.get('researcher') ?? '');
    await researcher.ask('POST', '/studies', {
      id: kStudy,
      title: 'Which bone is softer?',
      scenarios: [{ tuned: 'lateral_breach' }, { tuned: 'in_out_in' }],
      repeats: 1,
      participants: [
        { name: kParticipant, simulated: true },
        { name: kPerson, simulated: false },
      ],
    });
    kiosk = await startKiosk(bin, line, programme, ['--device', 'sim-rig', '--seed', '7', '--study', kStudy]);
  }, 240_000);
  afterAll(async () => {
    await kiosk.end();
    await browser.close();
    await line.cut();
    await served.stop();
  });

  it('takes a participant by the pseudonym alone, and nobody whom the study does not have', async () => {
    const person = await KioskPerson.before(browser, kiosk.address);
    await person.says('Type your participant number');
    await look(person, 'number');
    await person.scan('P99');
    await person.says('P99: No participant of this study has that number.');
    await look(person, 'unknown');
    await person.scan('100'); // the badge of a trainee
    await person.says('100: No participant of this study has that number.');
    await person.scan(kPerson);
    await person.fault('work'); // a simulated rig would record a simulated surgeon in a person's name
    await person.touch('Sign in');
    await person.screen('badge');
    await person.page.close();
  }, 120_000);

  it('shows no depth and no result, and goes on from the disk while the server is away', async () => {
    const person = await KioskPerson.before(browser, kiosk.address);
    await person.scan(kParticipant);
    await person.screen('work');
    await person.says('Trial 1 of 2');
    await look(person, 'work');
    await person.touch('Start');
    await person.screen('running');
    await person.says('This trial shows no depth.');
    await look(person, 'running');
    await person.answer('No breach', /75/);
    await person.screen('result');
    await person.says('Nobody sees results of this study before all your trials are done.');
    expect(await person.page.getByText(/correct/).count()).toBe(0);
    await look(person, 'result');
    expect(await recorded()).toBe(1);
    expect((await slots()).map(({ scenario, trials }) => [scenario, trials[0]?.correct ?? null])).toEqual([
      [null, null],
      [null, null],
    ]);

    await line.cut();
    await person.touch('Next trial');
    await person.screen('work');
    await person.says('Trial 2 of 2');
    await person.touch('Start');
    await person.answer('lateral', /75/);
    await person.screen('result');
    await person.says('is safe at this station');
    expect(await recorded()).toBe(1);
    await line.mend();
    await person.touch('Next trial');
    await person.screen('complete');
    await look(person, 'complete');
    await expect.poll(recorded, { timeout: 60_000 }).toBe(2);
    await person.page.close();
  }, 240_000);

  it('tells the researcher both answers once the participant is through', async () => {
    await scored(programme.admin);
    const found = await slots();
    expect(new Set(found.map(({ scenario }) => scenario))).toEqual(new Set(['Lateral breach', 'In, out and in again']));
    // Both scenarios have a breach: "no breach" is wrong, a breach is right.
    expect(found.map(({ trials }) => trials[0]?.correct)).toEqual([false, true]);
  }, 60_000);

  it('told the scenarios neither on the screen nor on the station’s disk', () => {
    const kept = files(programme.station.folder).map((path) => `${path}\n${readFileSync(path, 'latin1')}`);
    expect(kept.some((text) => text.includes(kStudy))).toBe(true);
    for (const text of [...seen, ...kept]) expect(text).not.toMatch(/lateral_breach|Lateral breach|in_out_in|In, out/);
  });
});
