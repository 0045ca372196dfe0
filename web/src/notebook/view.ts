// The machine in a cell of a notebook: 3-D view, main results, sliders of the pose, modes.

import { themeOf } from '../charts/look'
import { Animation } from '../machine3d/animation'
import { Scene } from '../machine3d/scene'
import { type Chosen, COLOURS } from '../snapshot/leg-colours'
import { poseRows } from '../snapshot/pose-rows'
import { readout } from '../snapshot/readout'
import { Stage, VIEWS } from '../snapshot/stage'
import { button, h, select, settled } from '../widgets/dom'
import { spring } from '../widgets/layout'
import type { Shared } from './model'
import { modesPart } from './modes'

const PATIENCE = 1500 // ms for an answer
const SILENT =
  'No answer yet: the kernel is busy, or there is none behind this page. The machine and its numbers are those of ' +
  'the last pose that was computed.'
const LAST = 'The machine and its numbers are those of the last pose that it could take.'
const UNITS = [
  ['mm', 'mm'],
  ['m', 'm'],
] as const

export class View {
  readonly element: HTMLElement
  private readonly scene: Scene
  private readonly stage: Stage
  private readonly animation: Animation
  private readonly results = readout()
  private readonly words = h('p', { class: 'words refused', role: 'alert', hidden: true })
  private readonly modes: { elements: HTMLElement[]; show(): void }
  private readonly pose: { elements: HTMLElement[]; show(): void }
  private colour: Chosen['colour'] = 'force'
  private unit: 'mm' | 'm' = 'mm'
  private readonly wait = settled(PATIENCE, () => this.tell(true))

  /** `host` is on the page and has its theme. */
  constructor(
    private readonly shared: Shared,
    host: HTMLElement,
  ) {
    const theme = () => themeOf(host)
    this.scene = new Scene(theme)
    this.scene.shareWheel()
    this.stage = new Stage(this.scene, theme)
    this.animation = new Animation(this.scene)
    this.modes = modesPart(shared, this.animation)
    this.pose = poseRows({
      pose: () => shared.get('_six'),
      box: () => shared.get('_drawn').box,
      unit: () => this.unit,
      put: (pose) => this.ask(pose),
    })
    const { notes, element } = this.stage
    const seen = h('div', { class: 'seen' }, this.tools(), this.results.element, element, notes, this.words)
    const set = h('div', { class: 'set' }, this.poseBar(), ...this.pose.elements, ...this.modes.elements)
    this.element = h(
      'div',
      { class: 'cell', role: 'group', 'aria-label': `The machine ${shared.get('_drawn').name}` },
      h('div', { class: 'machine' }, seen, set),
    )
    shared.on(['_snapshot', 'mode'], () => this.show())
    shared.on(['_six', '_snapshot', '_refused'], () => this.follow())
  }

  /** Show it for the first time, where it has its size, or anew in other colours. */
  begin(): void {
    this.show()
    this.follow()
  }

  look(view: keyof typeof VIEWS): void {
    this.scene.look(view)
  }

  /** Ask for a pose; the same again is no change that a model would tell of. */
  private ask(pose: number[]): void {
    this.shared.put('_six', pose)
    this.follow()
  }

  /** The machine at the last pose that it could take. */
  private show(): void {
    const s = this.shared.get('_snapshot')
    const mode = (this.shared.get('mode') ?? 0) - 1
    this.stage.show(s, this.shared.get('_drawn').leg, { colour: this.colour, mode })
    this.results.show(s)
    this.modes.show()
  }

  /** The sliders at the pose that is asked for, and whether the machine is there. */
  private follow(): void {
    this.pose.show()
    for (const part of [this.stage.element, this.results.element, ...this.modes.elements])
      part.classList.toggle('stale', !this.shared.answered)
    this.tell(false)
    this.wait()
  }

  /** Say why the machine is not at the pose that is asked for. */
  private tell(late: boolean): void {
    const { answered, refusal } = this.shared
    const words = refusal ? `${refusal} ${LAST}` : late ? SILENT : ''
    this.words.textContent = answered ? '' : words
    this.words.hidden = answered || !words
  }

  private tools(): HTMLElement {
    const names = Object.keys(VIEWS) as (keyof typeof VIEWS)[]
    const views = names.map((name) =>
      button(VIEWS[name], () => this.look(name), { class: 'quiet', title: `${name} view` }),
    )
    const colour = select('Colour of the legs', COLOURS, this.colour, (chosen) => {
      this.colour = chosen
      this.show()
    })
    const group = h('span', { role: 'group', 'aria-label': 'Standard views' }, ...views)
    return h('div', { class: 'bar tools' }, group, spring(), colour.element)
  }

  private poseBar(): HTMLElement {
    const home = button('Home', () => this.ask(this.shared.get('_drawn').home), {
      class: 'quiet',
      title: 'Move to the home pose; without one, to the pose where the view began',
    })
    const unit = select('Unit of lengths', UNITS, this.unit, (chosen) => {
      this.unit = chosen
      this.pose.show()
    })
    return h('div', { class: 'bar' }, h('h2', {}, 'Pose'), spring(), home, unit.element)
  }

  dispose(): void {
    this.shared.leave()
    this.animation.stop()
    this.scene.dispose()
  }
}
