// The base shaken at one frequency along one axis, in 3-D.

import type { Animation } from '../machine3d/animation'
import { twist } from '../machine3d/twist'
import { COORDINATES, type ShakenBase } from '../state/answers'
import { Live } from '../state/api'
import { page, type Question, store } from '../state/store'
import { choose, numberBox } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { sig } from '../widgets/format'
import { toolBar } from '../widgets/layout'
import { Result } from '../widgets/result'
import { TURN } from './response-lines'

const AXES = COORDINATES.map((c) => [c, c] as const)
const STILL = 'Drawn larger, at one instant: this computer asks for reduced motion.'
const SPEED = 0.7 // swings drawn per second

function shakeQuestion() {
  return { ...store.question(), omega: TURN * page.shake, axis: page.shake_axis, loss_factor: page.loss }
}

export class Shaker {
  readonly element: HTMLElement
  private readonly words = h('p', { class: 'hint', id: 'shake-words' })
  private readonly toggle = button('Shake the base', () => (this.on ? this.stop() : this.start()), { id: 'shake' })
  private readonly result: Result
  private readonly live = new Live<ShakenBase>(
    'api/shake',
    shakeQuestion,
    (answer, asked) => {
      this.result.shows(asked)
      if (this.on) this.play(answer, asked)
    },
    (error) => {
      this.stop()
      this.words.textContent = error.message
    },
  )
  private on = false

  constructor(
    private readonly animation: Animation,
    private readonly shown: () => boolean,
  ) {
    const frequency = numberBox('shake', 'Shaking frequency, Hz')
    const axis = choose('shake_axis', 'Axis of the base', AXES)
    this.result = new Result({ question: shakeQuestion, ask: () => this.start(), live: false, again: 'shake again' }, [
      this.words,
    ])
    const tools = [this.toggle, h('span', {}, 'along'), axis, h('span', {}, 'at'), frequency.input, h('span', {}, 'Hz')]
    this.element = h('div', {}, toolBar(...tools, frequency.wrong), this.result.framed())
    store.on(['snapshot'], () => this.suggest())
    store.on(['snapshot', 'shake', 'shake_axis', 'loss'], () => this.on && shown() && this.start())
    store.on(['tab', 'mode'], () => {
      if (this.on && (!shown() || page.mode >= 0)) this.stop()
    })
  }

  /** Shake at a frequency, Hz. */
  at(hertz: number): void {
    store.set({ shake: Number(hertz.toPrecision(5)) })
    this.start()
  }

  /** The first frequency is near that of the first mode. */
  private suggest(): void {
    const first = page.snapshot?.damped?.frequency.find((f) => f) ?? page.snapshot?.frequency[0]
    if (!page.shake && first) store.set({ shake: Number((0.97 * first).toPrecision(4)) })
  }

  private start(): void {
    this.on = page.shake > 0
    this.paint()
    if (this.on) this.live.request()
    else this.words.textContent = 'Give a frequency above 0 Hz.'
  }

  private play({ platform, base, ratio, reach }: ShakenBase, { omega, axis }: Question): void {
    if (!this.shown()) return
    if (page.mode >= 0) store.set({ mode: -1 })
    this.on = true
    this.paint()
    const hertz = Number(omega) / TURN
    this.animation.swing(
      'shake',
      (t) => {
        const [c, s] = [Math.cos(TURN * SPEED * t), Math.sin(TURN * SPEED * t)]
        const moved = platform.real.map((re, i) => re * c - platform.imag[i] * s)
        return [twist(moved, reach), twist(base, reach * c)]
      },
      SPEED,
    )
    const moves = `At ${sig(hertz, 4)} Hz the platform's ${axis} moves ${sig(ratio, 3)} times as far as the base's.`
    const how = this.animation.reduced ? STILL : `Drawn larger and ${sig(hertz / SPEED, 3)} times slower.`
    this.words.textContent = `${moves} ${how}`
  }

  private stop(): void {
    this.on = false
    this.animation.stop('shake')
    this.paint()
  }

  private paint(): void {
    this.toggle.textContent = this.on ? 'Stop' : 'Shake the base'
  }
}
