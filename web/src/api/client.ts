/** One way to the server: same origin, cookie, time-out, and every failure as an ApiError with a sentence for a person. */
import * as v from 'valibot';
import { say } from '@/language';
import { errorText } from './error-text';
import { nextSignIn } from './session-end';

const kRoot = '/api/v1';
const kTimeout_ms = 20_000;
/** Below it a 401 is an answer about the credentials that were sent. */
const kSession = '/session';

export type ApiErrorCode =
  | 'unauthorised'
  | 'code_needed'
  | 'forbidden'
  | 'not_found'
  | 'too_many'
  | 'unavailable'
  | 'unreachable'
  | 'unreadable'
  | 'refused';

export class ApiError extends Error {
  /** @param retryAfter_s when the server takes the request again; null: it did not say */
  constructor(
    readonly code: ApiErrorCode,
    message: string,
    readonly status = 0,
    readonly retryAfter_s: number | null = null,
  ) {
    super(message);
    this.name = 'ApiError';
  }
}

const errorSchema = v.object({ error: v.string(), code: v.string() });

function codeOf(status: number): ApiErrorCode {
  switch (status) {
    case 401:
      return 'unauthorised';
    case 403:
      return 'forbidden';
    case 404:
      return 'not_found';
    case 429:
      return 'too_many';
    case 502:
    case 503:
    case 504:
      return 'unavailable';
    default:
      return 'refused';
  }
}

interface Request {
  readonly method?: 'GET' | 'POST' | 'DELETE';
  readonly body?: unknown;
  /** JSON that is text already, sent as it is. */
  readonly text?: string;
  readonly bytes?: Uint8Array<ArrayBuffer>;
  readonly timeout_ms?: number;
  readonly signal?: AbortSignal | undefined;
}

/** What is sent, with the name of its kind. */
function content({ body, text, bytes: raw }: Request): { type: string; sent: string | Uint8Array<ArrayBuffer> } | null {
  if (raw !== undefined) return { type: 'application/octet-stream', sent: raw };
  if (text !== undefined) return { type: 'application/json', sent: text };
  return body === undefined ? null : { type: 'application/json', sent: JSON.stringify(body) };
}

/** A session that ended is no failure of what was asked: once the same person is back, it is asked again. */
async function send(path: string, request: Request): Promise<Response> {
  try {
    return await sendOnce(path, request);
  } catch (reason) {
    const ended = reason instanceof ApiError && reason.code === 'unauthorised' && !path.startsWith(kSession);
    if (!ended) throw reason;
    if (await nextSignIn(request.signal)) return send(path, request);
    throw new ApiError('refused', say('Another person has signed in.'));
  }
}

/** Abbreviations in the names of fields, as a person writes them. */
const kFieldWords: Record<string, string | undefined> = { pin: 'PIN', csv: 'CSV', id: 'ID', utc: '', us: '' };

/** "body/pin: 4 to 12 digits are expected" as "PIN: 4 to 12 digits are expected"; other messages as they are. */
export function withoutPointer(message: string): string {
  const [, pointer, rest] = /^(?:body(?:: )?)?((?:\/[\w*-]+)+): (.+)$/s.exec(message) ?? [];
  if (pointer === undefined || rest === undefined) return message.replace(/^body: /, '');
  const names = pointer.split('/').filter((part) => part !== '' && part !== '*');
  const words = names.map((part) =>
    /^\d+$/.test(part)
      ? `${Number(part) + 1}`
      : part
          .split('_')
          .map((word) => kFieldWords[word] ?? word)
          .filter(Boolean)
          .join(' '),
  );
  const name = words.join(' ');
  return `${name.charAt(0).toUpperCase()}${name.slice(1)}: ${rest}`;
}

async function sendOnce(path: string, request: Request): Promise<Response> {
  const { method = 'GET', timeout_ms = kTimeout_ms, signal } = request;
  const payload = content(request);
  const headers = new Headers({ Accept: 'application/json' });
  if (method !== 'GET') headers.set('X-Tractus', '1'); // refuses requests forged by another site
  if (payload) headers.set('Content-Type', payload.type);
  const timeout = AbortSignal.timeout(timeout_ms);
  let response: Response;
  try {
    response = await fetch(kRoot + path, {
      method,
      headers,
      credentials: 'same-origin',
      ...(payload ? { body: payload.sent } : {}),
      signal: signal ? AbortSignal.any([signal, timeout]) : timeout,
    });
  } catch (reason) {
    if (signal?.aborted) throw reason;
    throw new ApiError(
      'unreachable',
      say('The server does not answer. Check that it is running and that this computer is connected to the network.'),
    );
  }
  if (response.ok) return response;
  throw failureOf(response.status, await response.json().catch(() => undefined), response.headers.get('Retry-After'));
}

/** What a refusal says. */
function failureOf(status: number, json: unknown, retryAfter: string | null = null): ApiError {
  const failure = v.safeParse(errorSchema, json);
  const text = failure.success
    ? errorText(failure.output.code, withoutPointer(failure.output.error))
    : say('The server answered with status {status}.', { status });
  const needsCode = failure.success && failure.output.code === 'code_needed';
  return new ApiError(
    needsCode ? 'code_needed' : codeOf(status),
    text,
    status,
    retryAfter === null ? null : Number(retryAfter),
  );
}

/** Asks for JSON and checks it against `schema`; an answer of another shape is an error, never a half-filled page. */
export async function requestJson<Schema extends v.GenericSchema>(
  path: string,
  schema: Schema,
  request: Request = {},
): Promise<v.InferOutput<Schema>> {
  const response = await send(path, request);
  return read(schema, await response.json().catch(() => undefined));
}

function read<Schema extends v.GenericSchema>(schema: Schema, json: unknown): v.InferOutput<Schema> {
  const parsed = v.safeParse(schema, json);
  if (parsed.success) return parsed.output;
  const [issue] = parsed.issues;
  const where = v.getDotPath(issue) ?? 'answer';
  throw new ApiError(
    'unreadable',
    say("The server's answer cannot be read: {where}: {why}", { where, why: issue.message }),
  );
}

/** Sends a file and says what share of it has gone: fetch does not tell. */
export function sendFile<Schema extends v.GenericSchema>(
  path: string,
  schema: Schema,
  file: Blob,
  onShare: (share: number) => void,
): Promise<v.InferOutput<Schema>> {
  return new Promise((resolve, reject) => {
    const wire = new XMLHttpRequest();
    wire.open('POST', kRoot + path);
    wire.setRequestHeader('Accept', 'application/json');
    wire.setRequestHeader('Content-Type', 'application/octet-stream');
    wire.setRequestHeader('X-Tractus', '1');
    wire.upload.onprogress = ({ loaded, total }) => onShare(total > 0 ? loaded / total : 0);
    wire.onerror = () =>
      reject(new ApiError('unreachable', say('The connection broke before the file was there. Send it again.')));
    wire.onload = () => {
      let json: unknown;
      try {
        json = JSON.parse(wire.responseText);
        if (wire.status >= 200 && wire.status < 300) {
          resolve(read(schema, json));
          return;
        }
      } catch (reason) {
        if (reason instanceof ApiError) {
          reject(reason);
          return;
        }
      }
      reject(failureOf(wire.status, json));
    };
    wire.send(file);
  });
}

export async function request(path: string, request: Request): Promise<void> {
  await send(path, request);
}

/** Bytes with the headers that describe them. */
export async function bytes(
  path: string,
  request: Request = {},
): Promise<{ headers: Headers; data: Uint8Array<ArrayBuffer> }> {
  const response = await send(path, request);
  return { headers: response.headers, data: new Uint8Array(await response.arrayBuffer()) };
}
