/** The system behind the page: a process of its own that can be ended, killed and started again. */
import { spawn, type ChildProcess } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';

/** `nursing-home`: with David alone. `as-opened`: as whoever tries it first opens it. `two-robots`: with one that can fall silent. */
export type Program = keyof typeof DEMOS | 'two-robots';

export interface System {
  /** Where its page is, with a slash at the end. */
  readonly address: string;
  /** What it printed since it was started last. */
  readonly output: () => string;
  /** Write a line to its standard input. */
  tell: (line: string) => void;
  /** End it at once, as a power cut would. */
  kill: () => Promise<void>;
  /** End it in order. */
  end: () => Promise<void>;
  /** Start it again, with what it kept and under the same address. */
  start: () => Promise<void>;
  /** End it, and remove what it kept. */
  close: () => Promise<void>;
}

const DEMOS = {
  'nursing-home': ['nursing-home', '--robots', 'David'],
  'as-opened': ['nursing-home'],
  parking: ['parking'],
  warehouse: ['warehouse'],
  fleet: ['fleet'],
} as const;
const PARLEY = resolve(process.env.PARLEY_COMMAND ?? '../.venv/bin/parley');
const START_MS = 60_000;
const END_MS = 10_000;

/**
 * Start it on a free port, with a new folder.
 * @throws Error It did not serve its page in time; its output is in the message.
 */
export async function startSystem(program: Program, options: readonly string[]): Promise<System> {
  const data = await mkdtemp(join(tmpdir(), 'parley-e2e-'));
  let running = await begin(program, ['--port', '0', '--data', data, ...options]);
  const { address } = running;
  return {
    address,
    output: () => running.output(),
    tell: (line) => void running.process.stdin?.write(`${line}\n`),
    kill: () => ended(running.process, 'SIGKILL'),
    end: () => ended(running.process, 'SIGINT'),
    start: async () => {
      running = await begin(program, ['--port', new URL(address).port, '--data', data, ...options]);
    },
    close: async () => {
      await ended(running.process, 'SIGINT');
      await rm(data, { recursive: true, force: true });
    },
  };
}

interface Running {
  process: ChildProcess;
  address: string;
  output: () => string;
}

function begin(program: Program, options: readonly string[]): Promise<Running> {
  const [command, ...first] =
    program === 'two-robots'
      ? [join(dirname(PARLEY), 'python'), '-m', 'tests.web.e2e.two_robots']
      : [PARLEY, 'demo', ...DEMOS[program], '--no-open'];
  const child = spawn(command ?? PARLEY, [...first, ...options], { cwd: resolve('..'), stdio: 'pipe' });
  return new Promise((settle, reject) => {
    let output = '';
    const give = (failed: string) => {
      child.kill('SIGKILL');
      reject(new Error(`${failed}:\n${output}`));
    };
    const timer = setTimeout(() => give(`no page after ${START_MS} ms`), START_MS);
    const listen = (data: Buffer) => {
      output += data.toString();
      const found = /(https?:\/\/127\.0\.0\.1:\d+\/)[^]*Ctrl-C ends it/.exec(output)?.[1];
      if (!found) return;
      clearTimeout(timer);
      settle({ process: child, address: found, output: () => output });
    };
    child.stdout.on('data', listen);
    child.stderr.on('data', listen);
    child.once('error', reject);
    child.once('exit', (code) => {
      clearTimeout(timer);
      reject(new Error(`the system ended with ${code}:\n${output}`));
    });
  });
}

function ended(child: ChildProcess, signal: 'SIGINT' | 'SIGKILL'): Promise<void> {
  return new Promise((settle) => {
    if (child.exitCode !== null || child.signalCode !== null) {
      settle();
      return;
    }
    const timer = setTimeout(() => child.kill('SIGKILL'), END_MS);
    child.once('exit', () => {
      clearTimeout(timer);
      settle();
    });
    child.kill(signal);
  });
}
