/** A residency's first week, furnished: experts with trials, stations for fast hands and for two kiosks, 24 residents in a list. All SIMULATED. */
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Line } from './kiosk-station';
import { furnish, scored, type Programme } from './programme';
import type { Served } from './real-server';

export const kPin = '2580';
export const kExperts = 'Experts (simulated)',
  kResidents = 'Residents 2027';

const kSurnames =
  'Abel Berg Conti Duarte Egger Frank Gallo Haas Ito Jansen Kaya Lindt Moreau Nord Okoye Perez Quist Rossi Sato Toth Ueda Vogel Weber Yilmaz';
export const kClass = kSurnames.split(' ').map((surname, i) => ({
  name: `Simulated ${surname}`,
  badge: String(701 + i),
}));
/** As a spreadsheet writes it. */
export const kClassList = [
  'Full name;PGY;Badge number;PIN',
  ...kClass.map(({ name, badge }, i) => `${name};PGY-${String(1 + (i % 2))};${badge};${kPin}`),
].join('\n');

const kExpertBadges = ['601', '602', '603'];

export interface Residency {
  readonly programme: Programme;
  /** One of its own for each kiosk: the line of one is cut. */
  readonly kiosks: readonly { readonly programme: Programme; readonly line: Line }[];
  /** A simulated hand at the station of fast hands, in simulated time. */
  readonly hand: (badge: string, trials: number, ...more: string[]) => void;
}

/** A station more, enrolled by its code. */
async function station(served: Served, bin: string, { admin }: Programme, name: string): Promise<Programme['station']> {
  const folder = join(served.folder, name.replaceAll(' ', '-')),
    token = `${folder}.token`;
  mkdirSync(folder);
  writeFileSync(join(folder, 'config.json'), JSON.stringify({ format: 'tractus-station/1', name }));
  const { code } = await admin.ask<{ code: string }>('POST', '/stations/codes', { name });
  const words = ['enrol', '--server', served.url, '--code', code, '--token-file', token];
  execFileSync(join(bin, 'tractus-station'), words, { stdio: 'pipe' });
  const { stations } = await admin.ask<{ stations: { id: string; name: string }[] }>('GET', '/stations');
  return { folder, token, id: stations.find((one) => one.name === name)?.id ?? '' };
}

async function experts({ admin }: Programme, hand: Residency['hand']): Promise<void> {
  const { id: cohort } = await admin.ask<{ id: string }>('POST', '/cohorts', { name: kExperts });
  for (const [i, badge] of kExpertBadges.entries()) {
    const name = `Simulated expert ${String(i + 1)}`;
    await admin.ask('POST', '/accounts', { name, role: 'trainee', badge, pin: kPin });
    await admin.ask('POST', `/cohorts/${cohort}/people`, { name });
    await admin.ask('POST', '/consents', { account: name, tier: 'metrics', basis: 'simulated: no person' });
  }
  const cases = [{ scenario: { tuned: 'hard' } }, { scenario: { tuned: 'lateral_breach' } }];
  await admin.ask('POST', '/assignments', { title: 'Experts’ trials', cases, cohort, repeats: 3, release: 'held' });
  for (const [i, badge] of kExpertBadges.entries())
    hand(badge, 6, '--skill', String(0.85 + 0.05 * i), '--seed', String(100 * (i + 1)));
  await scored(admin);
}

export async function furnishResidency(served: Served, bin: string): Promise<Residency> {
  const programme = await furnish(served, bin);
  const pin = join(served.folder, 'pin');
  const hand: Residency['hand'] = (badge, trials, ...more) => {
    const words = ['assigned', '--badge', badge, '--pin-file', pin, '--device', 'sim-rig', '--speed', 'fast'];
    programme.station_does(...words, '--trials', String(trials), '--json', ...more);
  };
  await experts(programme, hand);
  const kiosks = [];
  for (const name of ['kiosk 1', 'kiosk 2'])
    kiosks.push({
      programme: { ...programme, station: await station(served, bin, programme, name) },
      line: await Line.to(served.url),
    });
  return { programme, kiosks, hand };
}
