// The playback of a simulation: plots with a moving line, and the machine in 3-D.

import { joinedFigure } from '../charts/line-figure'
import { LinePlot } from '../charts/lines'
import { onTheme } from '../charts/theme'
import type { Animation } from '../machine3d/animation'
import { page, store } from '../state/store'
import { button, h, select } from '../widgets/dom'
import { saveCsv } from '../widgets/download'
import { sig } from '../widgets/format'
import { toolBar } from '../widgets/layout'
import { endOf, type Run, runLines, runTable, twistsAt } from './simulation-run'

const SPEEDS = [
  ['0.25', '¼ speed'],
  ['1', 'speed 1'],
  ['4', 'speed 4'],
] as const

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
  private readonly words = h('output', { class: 'now' })
  private readonly toggle = button('Pause', () => this.turn(!this.playing), {})
  private readonly speed = select('Speed', SPEEDS, '1', () => undefined)
  private run: Run | null = null
  private playing = false
  private at = 0 // s
  private last = 0 // time of the last step, ms

  constructor(private readonly animation: Animation) {
    this.slider.addEventListener('input', () => this.seek(Number(this.slider.value) * this.end))
    const tools = toolBar(this.toggle, this.speed.element, this.slider, this.words)
    this.element = h('div', { hidden: true }, tools, ...this.plots.map((plot) => plot.element))
    store.on(['tab'], () => page.tab !== 'time' && this.turn(false))
    store.on(['pose', 'text', 'changes'], () => this.leave())
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
    this.turn(true)
  }

  private draw(): void {
    if (!this.run) return
    runLines(this.run).forEach((lines, i) => {
      this.plots[i].show(lines)
    })
  }

  private turn(on: boolean): void {
    this.playing = on
    this.toggle.textContent = on ? 'Pause' : 'Play'
    this.last = performance.now()
    if (on && this.at >= this.end) this.at = 0
    if (on) this.play()
    else if (page.tab !== 'time') this.animation.stop('time')
  }

  private play(): void {
    const run = this.run
    if (!run) return
    this.animation.play('time', () => {
      this.step(run)
      return twistsAt(run, this.at)
    })
  }

  /** Stop: another machine or pose is shown. */
  private leave(): void {
    if (!this.run) return
    this.turn(false)
    this.animation.stop('time')
  }

  private step(run: Run): void {
    const now = performance.now()
    if (this.playing) {
      this.at += ((now - this.last) / 1000) * run.speed * Number(this.speed.element.value)
      if (this.at > this.end) this.at = this.end > 0 ? this.at % this.end : 0
    }
    this.last = now
    this.slider.value = String(this.end ? this.at / this.end : 0)
    this.words.textContent = `${sig(this.at, 4)} s, drawn ${sig(run.factor, 3)} × larger`
    for (const plot of this.plots) plot.playhead(this.at)
  }

  private seek(seconds: number): void {
    this.at = Math.min(Math.max(seconds, 0), this.end)
    this.turn(false)
    this.play()
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
