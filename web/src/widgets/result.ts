// What a panel shows belongs to a question: design, pose, joint model, box, settings. When the page's question has
// changed, it is asked again where that is quick; until then, what is shown is greyed, says so, and cannot be used.

import { differences, listed } from '../state/question'
import { page, type Question, store } from '../state/store'
import { h, perFrame, settled } from './dom'

interface Options {
  /** What would be asked now. */
  question(): Question
  /** Ask it. */
  ask(): void
  /** Whether it is asked whenever it has changed and the result can be seen; otherwise when a person asks. */
  live: boolean
  /** What a person does to ask again, where the page does not do it. */
  again?: string
  /** ms without a change before it is asked. */
  delay?: number
  /** Called when what is shown begins or ceases to be the answer. */
  changed?(stale: boolean): void
}

export class Result {
  private readonly note: HTMLElement
  private answered: Question | null = null
  private attempted: Question | null = null
  private readonly soon: () => void
  private state = '' // none, current or stale

  /** `content` shows the result; `uses`, which may lie elsewhere, are buttons that use it: downloads, playback. */
  constructor(
    private readonly options: Options,
    private readonly content: HTMLElement[],
    private readonly uses: HTMLElement[] = [],
  ) {
    const { live, delay } = options
    this.note = h('p', { class: 'of-before', hidden: true, role: live ? null : 'status' })
    this.soon = settled(delay ?? 250, () => this.ask())
    store.onAny(perFrame(() => this.check()))
    store.on(['away'], () => {
      if (!page.away) this.attempted = null // what failed meanwhile is asked again
    })
  }

  /** The content with what is said of it. */
  framed(): HTMLElement {
    return h('div', { class: `result${this.options.live ? ' live' : ''}` }, this.note, ...this.content)
  }

  /** What is shown answers this question; null: nothing is shown. */
  shows(asked: Question | null): void {
    this.answered = asked
    if (asked) this.attempted = asked
    this.check()
  }

  /** Ask now. */
  ask(): void {
    this.attempted = this.options.question()
    this.options.ask()
  }

  private check(): void {
    if (!page.design) return
    const now = this.options.question()
    const differ = this.answered ? differences(this.answered, now) : []
    this.mark(differ)
    const asked = this.attempted && !differences(this.attempted, now).length
    if (this.options.live && !asked && !page.away && (differ.length || !this.answered) && this.content[0].offsetParent)
      this.soon()
  }

  private mark(differ: string[]): void {
    const stale = differ.length > 0
    const { again, changed } = this.options
    const words = `This belongs to ${differ.includes('settings') ? 'other' : 'another'} ${listed(differ)}`
    this.note.textContent = stale ? `${words}${again ? `: ${again}` : ''}.` : ''
    this.note.hidden = !stale
    for (const element of this.content) element.classList.toggle('stale', stale)
    const state = stale ? 'stale' : this.answered ? 'current' : 'none'
    if (this.state === state) return
    this.state = state
    for (const element of this.content) element.dataset.answer = state
    for (const use of this.uses)
      for (const control of [use, ...use.querySelectorAll<HTMLElement>('button, input')])
        if ('disabled' in control) control.disabled = stale
    changed?.(stale)
  }
}
