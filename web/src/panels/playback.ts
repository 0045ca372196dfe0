// The playback of a simulation: plots with a moving line, and the machine in 3-D.

import { joinedFigure } from '../charts/line-figure'
import { LinePlot } from '../charts/lines'
import { onTheme } from '../charts/theme'
import type { Animation } from '../machine3d/animation'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { saveCsv } from '../widgets/download'
import { sig } from '../widgets/format'
import { toolBar } from '../widgets/layout'
import { LineKeys } from './line-keys'
import { endOf, type Run, runLines, runTable, twistsAt } from './simulation-run'

const SPEEDS = [
  ['fit', 'the whole in 8 s'],
  ['1', 'real time'],
  ['10', '10 times slower'],
  ['100', '100 times slower'],
  ['1000', '1000 times slower'],
] as const
const [DISPLACEMENTS, FORCES] = [[0, 1], [2]]

export class Playback {
  readonly element: HTMLElement
  private readonly plots = [0, 1, 2].map(() => {
    return new LinePlot(
      () => 200,
      (seconds) => this.seek(seconds),
      'time',
    )
  })
  private readonly slider = h('input', {
    type: 'range',
    min: 0,
    max: 1,
    step: 'any',
    value: 0,
    'aria-label': 'Time of the playback',
  })
  readonly tools: HTMLElement
  private readonly keys = [DISPLACEMENTS, FORCES].map(
    (at) =>
      new LineKeys(
        'hidden_time',
        at.map((i) => this.plots[i]),
      ),
  )
  private readonly words = h('output', { class: 'now' })
  private readonly toggle = button('Pause', () => this.turn(!this.playing), {})
  private run: Run | null = null
  private playing = false
  private at = 0 // s
  private last = 0 // time of the last step, ms

  constructor(private readonly animation: Animation) {
    this.slider.addEventListener('input', () => this.seek(Number(this.slider.value) * this.end))
    this.tools = toolBar(this.toggle, choose('speed', 'Speed', SPEEDS), this.slider, this.words)
    const plots = this.keys.flatMap((keys, k) => [
      keys.element,
      ...[DISPLACEMENTS, FORCES][k].map((i) => this.plots[i].element),
    ])
    this.element = h('div', { hidden: true }, this.tools, ...plots)
    store.on(['tab'], () => page.tab !== 'time' && this.turn(false))
    store.on(['speed'], () => this.run && this.tell(this.run))
    onTheme(() => {
      this.draw()
      for (const plot of this.plots) plot.build()
    })
  }

  private get end(): number {
    return this.run ? endOf(this.run) : 0
  }

  take(run: Run): void {
    this.run = run
    this.element.hidden = false
    this.draw()
    this.at = 0
    store.set({ mode: -1 })
    this.turn(!this.animation.reduced) // where motion is not wanted, it waits for Play
  }

  private draw(): void {
    if (!this.run) return
    const lines = runLines(this.run)
    lines.forEach((shown, i) => {
      this.plots[i].show(shown)
    })
    this.keys[0].show([...lines[0].series, ...lines[1].series])
    this.keys[1].show(lines[2].series)
  }

  private turn(on: boolean): void {
    this.playing = on
    this.toggle.textContent = on ? 'Pause' : 'Play'
    this.last = performance.now()
    const { run } = this
    if (!run) return
    if (on && this.at >= this.end) this.at = 0
    if (on)
      this.animation.play('time', () => {
        this.advance(run)
        return twistsAt(run, this.at)
      })
    else if (page.tab !== 'time') this.animation.stop('time')
    else this.animation.hold('time', twistsAt(run, this.at))
    this.tell(run)
  }

  /** Stop: the run belongs to another machine or pose than the one shown. */
  leave(): void {
    if (!this.run) return
    this.turn(false)
    this.animation.stop('time')
  }

  private advance(run: Run): void {
    const now = performance.now()
    this.at += ((now - this.last) / 1000) * pace(run)
    if (this.at > this.end) this.at = this.end > 0 ? this.at % this.end : 0
    this.last = now
    this.tell(run)
  }

  private tell(run: Run): void {
    this.slider.value = String(this.end ? this.at / this.end : 0)
    const size = run.factor === 1 ? 'to scale' : `${sig(run.factor, 3)} × larger`
    this.words.textContent = `${sig(this.at, 4)} s, ${slowing(pace(run))}, drawn ${size}`
    for (const plot of this.plots) plot.playhead(this.at)
  }

  private seek(seconds: number): void {
    this.at = Math.min(Math.max(seconds, 0), this.end)
    this.turn(false)
  }

  csv(): void {
    if (this.run) saveCsv('simulation', ...runTable(this.run))
  }

  figure(): SVGSVGElement {
    return joinedFigure(
      this.plots.map((plot) => plot.figure()),
      1,
    )
  }
}

/** Simulated seconds in a second of playback. */
function pace(run: Run): number {
  return page.speed === 'fit' ? run.speed : 1 / Number(page.speed)
}

function slowing(pace: number): string {
  if (Math.abs(pace - 1) < 0.005) return 'in real time'
  return pace < 1 ? `${sig(1 / pace, 3)} times slower` : `${sig(pace, 3)} times faster`
}
