// The design as text, with line numbers and errors at their lines.

import type { FieldError } from '../state/answers'
import { Refused } from '../state/api'
import { page, store } from '../state/store'
import { button, h, settled } from '../widgets/dom'
import { describe, shown } from './opening'

const LINE = 18 // px

export class DesignEditor {
  readonly element: HTMLElement
  /** The text on screen if it is not that of the machine shown: no valid design, or not yet read. */
  get draft(): string | null {
    return this.drafting ? this.area.value : null
  }

  private drafting = false
  private readonly area = h('textarea', {
    class: 'code',
    spellcheck: 'false',
    autocomplete: 'off',
    wrap: 'off',
    'aria-label': 'Design file (TOML)',
    rows: 30,
  })
  private readonly gutter = h('div', { class: 'gutter', 'aria-hidden': 'true' })
  private readonly list = h('ul', { class: 'errors', role: 'alert' })

  constructor() {
    this.element = h('div', {}, this.list, h('div', { class: 'editor', 'data-part': 'design' }, this.gutter, this.area))
    const read = settled(400, () => void this.read(this.area.value))
    this.area.addEventListener('input', () => {
      this.drafting = true
      this.number([])
      read()
    })
    this.area.addEventListener('scroll', () => {
      this.gutter.scrollTop = this.area.scrollTop
    })
    store.on(['text'], () => {
      this.drafting = false
    })
    store.on(['design'], () => this.follow())
  }

  /** Show a text that is not a valid design. */
  show(text: string, errors: FieldError[]): void {
    this.drafting = true
    this.area.value = text
    this.complain(errors)
  }

  /** Show the text of the machine's design, unless another one is being written. */
  private follow(): void {
    if (this.drafting || document.activeElement === this.area || !page.design) return
    this.area.value = page.design.toml
    this.complain([])
  }

  /** Show the machine of the text that was written, if it is a valid design. */
  private async read(text: string): Promise<void> {
    try {
      const design = await describe(text)
      if (text !== this.area.value) return
      this.drafting = false
      this.complain([])
      if (text !== page.text || Object.keys(page.changes).length) store.set(shown(text, design))
    } catch (error) {
      if (!(error instanceof Refused)) throw error
      if (text === this.area.value) this.complain(error.errors)
    }
  }

  private complain(errors: FieldError[]): void {
    this.list.replaceChildren(...errors.map((error) => this.item(error)))
    this.area.setAttribute('aria-invalid', String(errors.length > 0))
    this.number(errors)
  }

  private item({ line, message }: FieldError): HTMLElement {
    if (!line) return h('li', {}, message)
    return h(
      'li',
      {},
      button(`line ${line}`, () => this.goTo(line), { class: 'link' }),
      ': ',
      message,
    )
  }

  private number(errors: FieldError[]): void {
    const wrong = new Set(errors.map((error) => error.line))
    const lines = this.area.value.split('\n')
    const numbers = lines.map((_, i) => h('div', { class: wrong.has(i + 1) ? 'bad' : '' }, String(i + 1)))
    this.gutter.replaceChildren(...numbers)
    this.gutter.scrollTop = this.area.scrollTop
  }

  private goTo(line: number): void {
    const lines = this.area.value.split('\n')
    const start = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0)
    this.area.focus()
    this.area.setSelectionRange(start, start + lines[line - 1].length)
    this.area.scrollTop = Math.max(0, (line - 6) * LINE)
  }
}
