// Frequency response: how the platform follows the base, forces or leg commands; and the base shaken, in 3-D.

import { joinedFigure } from '../charts/line-figure'
import { LinePlot } from '../charts/lines'
import { categories, DASHES, onTheme } from '../charts/theme'
import type { Animation } from '../machine3d/animation'
import { COORDINATES, type FrequencyResponse } from '../state/answers'
import { Live } from '../state/api'
import { page, store } from '../state/store'
import { freshId, h, select, settled, status, svg } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { parsed } from '../widgets/format'
import { titleBar, toolBar } from '../widgets/layout'
import { responseLines, responseTable, TURN } from './response-lines'
import { Shaker } from './shake'

const QUANTITIES = [
  ['absolute', 'Transmissibility: motion by base motion'],
  ['relative', 'Motion relative to the base'],
  ['compliance', 'Compliance: motion by wrench'],
  ['command', 'Motion by leg command'],
  ['leg_force', 'Leg force by base motion'],
] as const
const LAYOUTS = [
  ['all', 'One panel per output'],
  ['one', 'One large panel'],
  ['phase', 'One large panel, phase'],
] as const
const UNITS = [
  ['Hz', 'Hz'],
  ['rad', 'rad/s'],
] as const
const OUTPUTS = COORDINATES.map((c, i) => [String(i), c] as const)
const HINT =
  'Exact tangent at rest, with damping. Dotted lines: damped natural frequencies. Click a plot to shake the base ' +
  'there; drag across to zoom, double-click to see all; click a name above to hide its line.'

/** Buttons that show and hide the lines of all plots by their names. */
class LineKeys {
  readonly element = h('div', { class: 'bar tools keys', role: 'group', 'aria-label': 'Lines shown' })
  private drawn = ''

  constructor(private readonly plots: LinePlot[]) {}

  show(names: string[], anew = false): void {
    if (this.drawn === names.join() && !anew) return
    this.drawn = names.join()
    this.element.replaceChildren(h('span', { class: 'hint' }, 'by'), ...names.map((name, i) => this.key(name, i)))
  }

  private key(name: string, i: number): HTMLElement {
    const stroke = { stroke: categories()[i], 'stroke-width': 2.5, 'stroke-dasharray': DASHES[i].join(' ') }
    const line = svg('line', { x1: 0, x2: 22, y1: 4, y2: 4, ...stroke })
    const sample = svg('svg', { width: 22, height: 8, 'aria-hidden': 'true' }, line)
    const key = h('button', { type: 'button', class: 'key', 'aria-pressed': 'true' }, sample, name)
    key.addEventListener('click', () => {
      const on = key.getAttribute('aria-pressed') !== 'true'
      key.setAttribute('aria-pressed', String(on))
      for (const plot of this.plots) plot.reveal(name, on)
    })
    return key
  }
}

class ResponsePanel {
  readonly element: HTMLElement
  private answer: FrequencyResponse | null = null
  private readonly note = status({ class: 'hint' })
  private readonly quantity = select('Response', QUANTITIES, 'absolute', () => this.live.request())
  private readonly layout = select('Panels', LAYOUTS, 'all', () => this.show())
  private readonly output = select('Output', OUTPUTS, '2', () => this.show())
  private readonly unit = select('Frequency axis', UNITS, 'Hz', () => this.show())
  private readonly loss = h('input', {
    type: 'text',
    class: 'number tiny',
    value: '0',
    id: freshId('loss'),
    inputmode: 'decimal',
    title: 'Structural damping of the legs, K (1 + iη)',
  })
  private readonly plots = COORDINATES.map(
    () =>
      new LinePlot(
        () => (this.whole ? 430 : 190),
        (x) => this.shaker.at(this.hertz ? x : x / TURN),
      ),
  )
  private readonly grid = h('div', { class: 'panels' }, ...this.plots.map((p) => p.element))
  private readonly keys = new LineKeys(this.plots)
  private readonly shaker: Shaker
  private readonly live = new Live<FrequencyResponse>(
    'api/response',
    () => ({ ...store.question(), quantity: this.quantity.element.value, loss_factor: parsed(this.loss.value) }),
    (answer) => {
      this.answer = answer
      this.show()
    },
    (error) => {
      this.note.textContent = error.message
    },
  )

  constructor(private readonly animation: Animation) {
    for (const plot of this.plots) plot.legend = false
    this.shaker = new Shaker(animation, () => page.tab === 'response')
    this.loss.addEventListener('change', () => this.live.request())
    this.output.element.hidden = true
    const tools = [this.quantity, this.layout, this.output, this.unit].map((choice) => choice.element)
    const name = () => `response-${this.quantity.element.value}`
    this.element = h(
      'div',
      { id: 'response' },
      titleBar(
        'h2',
        'Frequency response',
        csvButton('Response', () => this.answer && saveCsv(name(), ...responseTable(this.answer))),
        figureButtons(name, 'Response', () => this.figure()),
      ),
      toolBar(...tools, h('label', { for: this.loss.id }, 'loss factor'), this.loss),
      this.note,
      this.shaker.element,
      this.keys.element,
      this.grid,
      h('p', { class: 'hint' }, HINT),
    )
    this.listen()
  }

  private listen(): void {
    const refresh = settled(60, () => this.element.offsetParent && this.live.request())
    store.on(['snapshot'], refresh)
    store.on(['tab'], () => {
      requestAnimationFrame(refresh)
      if (page.tab !== 'response') this.animation.stop('shake')
    })
    onTheme(() => {
      if (this.answer) this.keys.show(this.answer.inputs, true)
      this.show()
      for (const plot of this.plots) plot.build()
    })
  }

  private get whole(): boolean {
    return this.layout.element.value !== 'all'
  }

  private get hertz(): boolean {
    return this.unit.element.value === 'Hz'
  }

  private show(): void {
    const { answer, whole, hertz } = this
    if (!answer) return
    this.note.textContent = ''
    this.keys.show(answer.inputs)
    this.output.element.hidden = !whole
    this.grid.classList.toggle('one', whole)
    const chosen = Number(this.output.element.value)
    const phase = this.layout.element.value === 'phase'
    this.plots.forEach((plot, i) => {
      plot.element.hidden = whole && i > 0
      if (!plot.element.hidden) plot.show(responseLines(answer, whole ? chosen : i, { phase, hertz }))
    })
    answer.outputs.forEach((name, i) => {
      this.output.element.options[i].textContent = name
    })
  }

  private figure(): SVGSVGElement {
    if (!this.whole)
      return joinedFigure(
        this.plots.map((plot) => plot.figure()),
        2,
      )
    return this.plots.find((plot) => plot.ready && !plot.element.hidden)!.figure()
  }
}

export function responsePanel(animation: Animation): HTMLElement {
  return new ResponsePanel(animation).element
}
