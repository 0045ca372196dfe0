// A mode that moves: its button, how far it is drawn, and how fast.

import type { Animation } from '../machine3d/animation'
import { noTwist, reach, twist } from '../machine3d/twist'
import type { Snapshot } from '../state/answers'
import { h } from '../widgets/dom'
import { sig } from '../widgets/format'

const SWINGS = 0.7 // of the animation per second
const STILL = 'Drawn still, at its greatest displacement: this computer asks for reduced motion.'

/** The button that moves a mode, counted from 0, or stops it. `hint`: what its title says besides. */
export function playButton(mode: number, chosen: boolean, hint = ''): HTMLButtonElement {
  const label = `Animate mode ${mode + 1}`
  const attributes = {
    'data-mode': mode,
    'aria-pressed': String(chosen),
    'aria-label': label,
    title: `${label}${hint}`,
  }
  return h('button', { type: 'button', class: 'play', ...attributes }, `${chosen ? '■' : '▶'} ${mode + 1}`)
}

/** Put new rows of modes into a table; the button that had the focus has it again. */
export function replaceModes(body: HTMLElement, rows: HTMLElement[]): void {
  const focused = body.querySelector<HTMLElement>('[data-mode]:focus')?.dataset.mode
  body.replaceChildren(...rows)
  if (focused) body.querySelector<HTMLElement>(`[data-mode="${focused}"]`)?.focus()
}

/** Largest displacement of a joint that is drawn, m; `share`: 0 to 1. */
export function drawnSize({ geometry: { platform } }: Snapshot, share: number): number {
  return share * 0.6 * Math.max(...platform.map((p) => Math.hypot(p[0], p[1], p[2])))
}

/** Play a mode with a largest displacement, m. */
export function playMode(animation: Animation, { geometry, shape }: Snapshot, mode: number, drawn: number): void {
  const { platform, matrix } = geometry
  const turned = platform.map((p) => matrix.map((r) => r[0] * p[0] + r[1] * p[1] + r[2] * p[2]))
  const scale = drawn / (reach(shape[mode], turned) || 1)
  const swing = (t: number) => scale * Math.sin(2 * Math.PI * SWINGS * t)
  animation.swing('mode', (t) => [twist(shape[mode], swing(t)), noTwist()], SWINGS)
}

/** How fast and how far a mode is drawn; `still`: it is not in motion. */
export function paceWords(s: Snapshot, mode: number, drawn: number, still: boolean): string {
  const largest = `The greatest joint displacement drawn is ${sig(1000 * drawn, 3)} mm.`
  return `${still ? STILL : `Drawn at ${SWINGS} swings a second${comparison(s.frequency[mode])}.`} ${largest}`
}

/** The animation beside a machine that vibrates at a frequency, Hz. */
function comparison(frequency: number | null): string {
  if (!frequency) return '; the machine itself does not swing back'
  const slower = frequency / SWINGS
  return slower >= 1 ? `, ${sig(slower, 3)} times slower than the machine` : `, ${sig(1 / slower, 3)} times faster`
}
