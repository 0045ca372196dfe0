// Frequency response: how the platform follows the base, forces or leg commands; and the base shaken, in 3-D.

import { joinedFigure } from '../charts/line-figure'
import { LinePlot } from '../charts/lines'
import { categories, DASHES, onTheme } from '../charts/theme'
import type { Animation } from '../machine3d/animation'
import { COORDINATES, type FrequencyResponse } from '../state/answers'
import { Live } from '../state/api'
import { page, store } from '../state/store'
import { choose, numberBox } from '../widgets/bound'
import { h, status } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { titleBar, toolBar } from '../widgets/layout'
import { Result } from '../widgets/result'
import { LineKeys } from './line-keys'
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
const OUTPUTS = (['1', '2', '3', '4', '5', '6'] as const).map((n, i) => [n, COORDINATES[i]] as const)
const LOSS_TITLE = 'Structural damping of the legs, K (1 + iη), in place of the design’s; 0: that of the design'
const HINT =
  'Exact tangent at rest, with damping. Dotted lines: damped natural frequencies. Click a plot to shake the base ' +
  'there; drag across to zoom, double-click to see all; click a name above to hide its line. Point at a plot to read ' +
  'its values.'

function responseQuestion() {
  return { ...store.question(), quantity: page.response, loss_factor: page.loss }
}

class ResponsePanel {
  readonly element: HTMLElement
  private answer: FrequencyResponse | null = null
  private readonly note = status({ class: 'wrong' })
  private readonly losses = h('p', { class: 'hint', id: 'losses' })
  private readonly output = choose('output', 'Output', OUTPUTS)
  private readonly plots = COORDINATES.map(
    () =>
      new LinePlot(
        () => (this.whole ? 430 : 190),
        (x) => this.shaker.at(this.hertz ? x : x / TURN),
      ),
  )
  private readonly grid = h('div', { class: 'panels' }, ...this.plots.map((p) => p.element))
  private readonly keys = new LineKeys('hidden', this.plots, 'by')
  private readonly shaker: Shaker
  private readonly result: Result
  private readonly live = new Live<FrequencyResponse>(
    'api/response',
    responseQuestion,
    (answer, asked) => {
      this.answer = answer
      this.result.shows(asked)
      this.show()
    },
    (error) => {
      this.note.textContent = error.message
    },
  )

  constructor(private readonly animation: Animation) {
    this.shaker = new Shaker(animation, () => page.tab === 'response')
    const name = () => `response-${page.response}`
    const csv = csvButton('Response', () => this.answer && saveCsv(name(), ...responseTable(this.answer)))
    const figures = figureButtons(name, 'Response', () => this.figure())
    this.result = new Result(
      { question: responseQuestion, ask: this.live.request, live: true, delay: 60 },
      [this.keys.element, this.grid],
      [csv, figures],
    )
    this.element = h(
      'div',
      { id: 'response' },
      titleBar('h2', 'Frequency response', csv, figures),
      this.tools(),
      this.losses,
      this.note,
      this.shaker.element,
      this.result.framed(),
      h('p', { class: 'hint' }, HINT),
    )
    this.listen()
  }

  private tools(): HTMLElement {
    const loss = numberBox('loss', 'Loss factor', { class: 'number tiny', title: LOSS_TITLE })
    return toolBar(
      choose('response', 'Response', QUANTITIES),
      choose('panels', 'Panels', LAYOUTS),
      this.output,
      choose('frequency_unit', 'Frequency axis', UNITS),
      h('span', {}, 'loss factor'),
      loss.input,
      loss.wrong,
    )
  }

  private listen(): void {
    store.on(['panels', 'output', 'frequency_unit'], () => this.show())
    store.on(['tab'], () => page.tab !== 'response' && this.animation.stop('shake'))
    onTheme(() => {
      this.show()
      for (const plot of this.plots) plot.build()
    })
  }

  private get whole(): boolean {
    return page.panels !== 'all'
  }

  private get hertz(): boolean {
    return page.frequency_unit === 'Hz'
  }

  private show(): void {
    const { answer, whole, hertz } = this
    if (!answer) return
    this.note.textContent = answer.caution
    this.losses.textContent = answer.losses
    this.output.hidden = !whole
    this.grid.classList.toggle('one', whole)
    const phase = page.panels === 'phase'
    this.plots.forEach((plot, i) => {
      plot.element.hidden = whole && i > 0
      const output = whole ? Number(page.output) - 1 : i
      if (!plot.element.hidden) plot.show(responseLines(answer, output, { phase, hertz }))
    })
    this.keys.show(answer.inputs.map((input, i) => ({ name: input, colour: categories()[i], dash: DASHES[i] })))
    answer.outputs.forEach((name, i) => {
      this.output.options[i].textContent = name
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
