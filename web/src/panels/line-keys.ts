// Buttons that show and hide the lines of plots by their names.

import type { LinePlot } from '../charts/lines'
import type { KeyOf } from '../state/options'
import { page, store } from '../state/store'
import { include } from '../widgets/bound'
import { h, svg } from '../widgets/dom'

export interface Line {
  name: string
  colour: string
  dash: number[]
}

export class LineKeys {
  readonly element = h('div', { class: 'bar tools keys', role: 'group', 'aria-label': 'Lines shown' })
  private lines: Line[] = []

  constructor(
    private readonly option: KeyOf<string[]>,
    private readonly plots: LinePlot[],
    private readonly before = '',
  ) {
    store.on([option], () => this.reveal())
  }

  show(lines: Line[]): void {
    if (JSON.stringify(lines) !== JSON.stringify(this.lines)) {
      this.lines = lines
      const before = this.before && h('span', { class: 'hint' }, this.before)
      this.element.replaceChildren(...[before, ...lines.map((line) => this.key(line))].filter((e) => e !== ''))
    }
    this.reveal()
  }

  private key({ name, colour, dash }: Line): HTMLElement {
    const stroke = { stroke: colour, 'stroke-width': 2.5, 'stroke-dasharray': dash.join(' ') }
    const line = svg('line', { x1: 0, x2: 22, y1: 4, y2: 4, ...stroke })
    const sample = svg('svg', { width: 22, height: 8, 'aria-hidden': 'true' }, line)
    const attributes = { type: 'button', class: 'key', 'data-option': this.option, 'data-name': name }
    const key = h('button', attributes, sample, name)
    key.addEventListener('click', () => include(this.option, name, !page[this.option].includes(name)))
    return key
  }

  private reveal(): void {
    for (const key of this.element.querySelectorAll<HTMLElement>('.key')) {
      const name = key.dataset.name!
      const on = !page[this.option].includes(name)
      key.setAttribute('aria-pressed', String(on))
      for (const plot of this.plots) plot.reveal(name, on)
    }
  }
}
