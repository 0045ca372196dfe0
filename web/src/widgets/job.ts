// A long job on the page: progress, time left, cancelling, and its error.

import type { Progress } from '../state/answers'
import { job, type Message, Refused } from '../state/api'
import type { Question } from '../state/store'
import { button, h, status } from './dom'
import { duration } from './format'

export class Runner {
  readonly bar = h('progress', { max: 1, value: 0, 'aria-label': 'Progress' })
  readonly words = status({ class: 'progress-words' })
  readonly cancel = button('Cancel', () => this.stop(), { class: 'quiet' })
  readonly element = h('div', { class: 'runner' }, this.bar, this.words, this.cancel)
  private running: AbortController | null = null

  constructor() {
    this.cancel.hidden = true
    this.bar.hidden = true
  }

  /** Run a job; one that still runs is stopped first. Resolves to whether the job was completed. */
  async run(kind: string, spec: Question, message: (message: Message, data: Uint8Array) => void): Promise<boolean> {
    this.running?.abort()
    const mine = new AbortController()
    this.running = mine
    this.cancel.hidden = false
    this.bar.removeAttribute('value')
    this.bar.hidden = false
    this.words.classList.remove('wrong')
    this.words.textContent = 'Starting…'
    try {
      for await (const [head, data] of job(kind, spec, mine.signal)) {
        if (head.type === 'job' && head.waiting) this.words.textContent = 'Waiting for other jobs to end…'
        if ('total' in head) this.progress(head)
        message(head, data)
      }
      return true
    } catch (error) {
      if (!mine.signal.aborted) this.fail(error instanceof Refused ? error.message : String(error))
      return false
    } finally {
      if (this.running === mine) {
        this.running = null
        this.cancel.hidden = true
        this.bar.hidden = true
      }
    }
  }

  private progress({ done, total, seconds }: Progress): void {
    this.bar.value = done / total
    const left = (seconds / Math.max(done, 1e-9)) * (total - done)
    this.words.textContent = `${Math.round((100 * done) / total)} %${left > 1 ? `, ${duration(left)} left` : ''}`
  }

  say(words: string): void {
    this.words.classList.remove('wrong')
    this.words.textContent = words
  }

  fail(words: string): void {
    this.words.classList.add('wrong')
    this.words.textContent = words
  }

  stop(): void {
    if (!this.running) return
    this.running.abort()
    this.running = null
    this.say('Cancelled. What had come is shown.')
  }

  get busy(): boolean {
    return this.running !== null
  }
}
