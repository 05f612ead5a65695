/** A kiosk for one test file: the station's program, the line to its server that can be cut, and a rig with an e-stop. */
import { spawn, type ChildProcess } from 'node:child_process';
import { connect, createServer, type AddressInfo, type Server, type Socket } from 'node:net';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import type { Programme } from './programme';

const kDist = fileURLToPath(new URL('../../dist', import.meta.url));

/** Between station and server: `cut` ends every connection and takes no new one until `mend`. */
export class Line {
  private readonly sockets = new Set<Socket>();
  private server: Server | undefined;
  private constructor(
    private readonly to: number,
    public port = 0,
  ) {}

  static async to(url: string): Promise<Line> {
    const line = new Line(Number(new URL(url).port));
    await line.mend();
    return line;
  }

  async mend(): Promise<void> {
    const server = createServer((from) => {
      const onward = connect(this.to, '127.0.0.1');
      for (const socket of [from, onward]) {
        this.sockets.add(socket);
        socket.on('error', () => socket.destroy());
        socket.on('close', () => this.sockets.delete(socket));
      }
      from.pipe(onward).pipe(from);
    });
    this.server = server;
    await new Promise<void>((resolve) => server.listen(this.port, '127.0.0.1', resolve));
    this.port = (server.address() as AddressInfo).port;
  }

  async cut(): Promise<void> {
    const closed = new Promise((resolve) => this.server?.close(resolve));
    for (const socket of this.sockets) socket.destroy();
    await closed;
  }
}

/** The first line of a program that goes on running. */
async function begun(program: string, words: readonly string[]): Promise<{ child: ChildProcess; line: string }> {
  const child = spawn(program, words, { stdio: ['ignore', 'pipe', 'inherit'] });
  const line = await new Promise<string>((resolve, reject) => {
    createInterface({ input: child.stdout }).once('line', resolve);
    child.once('exit', (code) => reject(new Error(`${program} has ended with ${String(code)}`)));
  });
  return { child, line };
}

async function ended(child: ChildProcess, signal: NodeJS.Signals): Promise<void> {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const over = new Promise((resolve) => child.once('exit', resolve));
  child.kill(signal);
  await over;
}

export interface Kiosk {
  readonly address: string;
  readonly end: (signal?: NodeJS.Signals) => Promise<void>;
}

const kioskWords = (line: Line, { folder, token }: Programme['station']) => [
  ...['kiosk', '--data', folder, '--server', `http://127.0.0.1:${String(line.port)}`],
  ...['--token-file', token, '--web', kDist, '--port', '0'],
];

export async function startKiosk(bin: string, line: Line, { station }: Programme, words: string[]): Promise<Kiosk> {
  const { child, line: said } = await begun(join(bin, 'tractus-station'), [
    ...kioskWords(line, station),
    ...['--no-browser', '--json', ...words],
  ]);
  const { address } = JSON.parse(said) as { address: string };
  return { address, end: (signal = 'SIGTERM') => ended(child, signal) };
}

/** With a browser of its own; the answer ends it. */
export function shown(bin: string, line: Line, { station }: Programme, words: string[]): () => Promise<void> {
  const child = spawn(join(bin, 'tractus-station'), [...kioskWords(line, station), ...words], { stdio: 'inherit' });
  return () => ended(child, 'SIGTERM');
}

/** Registers of the simulated world, station/devices/rig-registers.md, unit 240. */
const kWorldUnit = 240,
  kWriteOne = 6;
export const kStopButton = 4,
  kResetButton = 5,
  kStartButton = 8;

export interface Rig {
  readonly address: string;
  readonly press: (button: number, pressed: 0 | 1) => Promise<void>;
  readonly end: () => Promise<void>;
}

/** `tractus-rig`, as a machine at the end of a bus, with a SIMULATED surgeon. */
export async function startRig(bin: string): Promise<Rig> {
  const words = ['--port', '0', '--json', '--surgeon', '--seed', '7'];
  const { child, line } = await begun(join(bin, 'tractus-rig'), words);
  const { port } = JSON.parse(line) as { port: number };
  return {
    address: `127.0.0.1:${String(port)}`,
    press: async (button, pressed) => {
      const socket = connect(port, '127.0.0.1');
      // Modbus TCP: transaction, protocol, length, unit, function, register, value.
      socket.write(Buffer.from([0, 1, 0, 0, 0, 6, kWorldUnit, kWriteOne, 0, button, 0, pressed]));
      await new Promise((resolve, reject) => {
        socket.once('data', resolve);
        socket.once('error', reject);
      });
      socket.destroy();
    },
    end: () => ended(child, 'SIGKILL'),
  };
}
