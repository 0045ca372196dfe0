// The base shaken at one frequency along one axis, in 3-D.

import type { Animation } from '../machine3d/animation'
import { twist } from '../machine3d/twist'
import { COORDINATES, type ShakenBase } from '../state/answers'
import { ask, Refused } from '../state/api'
import { page, store } from '../state/store'
import { button, freshId, h, select, status } from '../widgets/dom'
import { field, parsed, sig } from '../widgets/format'
import { toolBar } from '../widgets/layout'
import { TURN } from './response-lines'

const SPEED = 0.7 // swings drawn per second

export class Shaker {
  readonly element: HTMLElement
  private readonly frequency = h('input', {
    type: 'text',
    class: 'number',
    inputmode: 'decimal',
    id: freshId('shake'),
    'aria-label': 'Shaking frequency, Hz',
  })
  private readonly axis = select(
    'Axis of the base',
    COORDINATES.map((c) => [c, c] as const),
    'z',
    () => void this.start(),
  )
  private readonly words = status({ class: 'hint', id: 'shake-words' })
  private readonly toggle = button('Shake the base', () => (this.on ? this.stop() : void this.start()), {
    'aria-pressed': 'false',
    id: 'shake',
  })
  private on = false

  constructor(
    private readonly animation: Animation,
    private readonly shown: () => boolean,
  ) {
    const tools = [this.toggle, h('span', {}, 'along'), this.axis.element, h('span', {}, 'at'), this.frequency]
    this.element = h('div', {}, toolBar(...tools, h('span', {}, 'Hz')), this.words)
    this.frequency.addEventListener('change', () => void this.start())
    store.on(['snapshot'], () => this.follow())
    store.on(['tab', 'mode'], () => {
      if (this.on && (!shown() || page.mode >= 0)) this.stop()
    })
  }

  /** Shake at a frequency, Hz. */
  at(hertz: number): void {
    this.frequency.value = field(Number(hertz.toPrecision(5)))
    void this.start()
  }

  /** After a change of the machine, shake it again. The first frequency is near that of the first mode. */
  private follow(): void {
    const first = page.snapshot?.damped?.frequency[0] ?? page.snapshot?.frequency[0]
    if (!this.frequency.value && first) this.frequency.value = field(Number((0.97 * first).toPrecision(4)))
    if (this.on && this.shown()) void this.start()
  }

  private async start(): Promise<void> {
    const hertz = parsed(this.frequency.value)
    if (!(hertz > 0)) {
      this.words.textContent = `The frequency is ${this.frequency.value || 'empty'}; give a number of Hz above 0.`
      return
    }
    try {
      const axis = this.axis.element.value
      this.play(await ask<ShakenBase>('api/shake', { ...store.question(), omega: TURN * hertz, axis }), axis, hertz)
    } catch (error) {
      if (!(error instanceof Refused)) throw error
      this.words.textContent = error.message
    }
  }

  private play({ platform, base, ratio, reach }: ShakenBase, axis: string, hertz: number): void {
    if (page.mode >= 0) store.set({ mode: -1 })
    this.on = true
    this.paint()
    this.animation.play('shake', (t) => {
      const [c, s] = [Math.cos(TURN * SPEED * t), Math.sin(TURN * SPEED * t)]
      const moved = platform.real.map((re, i) => re * c - platform.imag[i] * s)
      return [twist(moved, reach), twist(base, reach * c)]
    })
    const moves = `At ${sig(hertz, 4)} Hz the platform's ${axis} moves ${sig(ratio, 3)} times as far as the base's.`
    this.words.textContent = `${moves} Drawn larger and ${sig(hertz / SPEED, 3)} times slower.`
  }

  private stop(): void {
    this.on = false
    this.animation.stop('shake')
    this.paint()
  }

  private paint(): void {
    this.toggle.textContent = this.on ? 'Stop' : 'Shake the base'
    this.toggle.setAttribute('aria-pressed', String(this.on))
  }
}
