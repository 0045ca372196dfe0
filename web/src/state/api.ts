// Requests to the server: single answers, answers that follow a state, and streams of binary numbers.

import type { FieldError, JobFailure, JobMessage, Refusal } from './answers'
import type { Question } from './store'

/** The server refuses a request; `errors` stand at the fields that are wrong. */
export class Refused extends Error {
  readonly errors: FieldError[]

  constructor(message: string, fields: FieldError[] = []) {
    super(message)
    this.errors = fields.length ? fields : [{ key: '', message, line: 0 }]
  }
}

/** The server does not answer at all. */
export class Unreachable extends Refused {
  constructor() {
    super('The server does not answer. Is `flexapod serve` still running?')
  }
}

let lost: () => void = () => undefined

/** Set what is told whenever the server does not answer. */
export function onLost(tell: () => void): void {
  lost = tell
}

function unreachable(): Unreachable {
  lost()
  return new Unreachable()
}

/** Whether the server answers. */
export async function answers(): Promise<boolean> {
  try {
    return (await fetch('icon.svg', { method: 'HEAD', cache: 'no-store' })).ok
  } catch {
    return false
  }
}

async function send(path: string, body: unknown, signal?: AbortSignal): Promise<Response> {
  let response: Response
  try {
    response = await fetch(path, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify(body),
      signal,
    })
  } catch (error) {
    if (signal?.aborted) throw error
    throw unreachable()
  }
  if (response.ok) return response
  const answer: Refusal = await response
    .json()
    .catch(() => ({ error: `the server answered ${response.status}`, fields: [] }))
  throw new Refused(answer.error, answer.fields)
}

export async function ask<T>(path: string, body: unknown): Promise<T> {
  return (await send(path, body)).json()
}

export async function get<T>(path: string): Promise<T> {
  return (await fetch(path)).json()
}

/** Sends one request at a time. Requests made meanwhile become one, with the values of then. */
export class Live<T> {
  private busy = false
  private stale = false

  constructor(
    private readonly path: string,
    private readonly body: () => Question,
    private readonly answered: (answer: T, asked: Question) => void,
    private readonly failed: (error: Refused) => void,
  ) {}

  readonly request = (): void => {
    this.stale = true
    if (!this.busy) void this.run()
  }

  private async run(): Promise<void> {
    this.busy = true
    while (this.stale) {
      this.stale = false
      const asked = this.body()
      try {
        const answer = await ask<T>(this.path, asked)
        this.answered(answer, asked)
      } catch (error) {
        if (!(error instanceof Refused)) throw error
        const meant = JSON.stringify(asked) === JSON.stringify(this.body()) // otherwise a newer request follows
        if (meant) this.failed(error)
      } finally {
        if (!this.stale) this.busy = false
      }
    }
  }
}

/** A message of a job that goes well: a failure is thrown as Refused. */
export type Message = Exclude<JobMessage, JobFailure>

/** Reads a stream in pieces of given lengths; null at its end. */
function pieces(reader: ReadableStreamDefaultReader<Uint8Array>): (length: number) => Promise<Uint8Array | null> {
  let held: Uint8Array = new Uint8Array(0)
  return async (length) => {
    const parts: Uint8Array[] = [held]
    let have = held.length
    while (have < length) {
      const { done, value } = await reader.read().catch((error: unknown) => {
        if (error instanceof DOMException) throw error // the page itself stops the job
        throw unreachable()
      })
      if (done) return null
      parts.push(value)
      have += value.length
    }
    const all = parts.length === 1 ? held : joined(parts, have)
    held = all.subarray(length)
    return all.subarray(0, length)
  }
}

/** A long job's messages as they come. Aborting the signal stops the job on the server too. */
export async function* job(kind: string, spec: Question, signal: AbortSignal): AsyncGenerator<[Message, Uint8Array]> {
  const response = await send(`api/jobs/${kind}`, spec, signal)
  const take = pieces(response.body!.getReader())
  for (;;) {
    const head = await take(8)
    if (!head) return
    const sizes = new DataView(head.buffer, head.byteOffset, 8)
    const text = await take(sizes.getUint32(0, true))
    const data = await take(sizes.getUint32(4, true))
    if (!text || !data) throw new Refused('the answer of a job broke off')
    const message = JSON.parse(new TextDecoder().decode(text)) as Message | JobFailure
    if (message.type === 'failed') throw new Refused(message.error)
    yield [message, data]
  }
}

function joined(parts: Uint8Array[], size: number): Uint8Array {
  const all = new Uint8Array(size)
  let at = 0
  for (const part of parts) {
    all.set(part, at)
    at += part.length
  }
  return all
}

/** Binary numbers of a message; copied, since they need not lie on a multiple of four bytes. */
export function floats(data: Uint8Array): Float32Array {
  return new Float32Array(data.slice().buffer)
}
