// What colours the legs: the chosen quantity, its colour map and its colour bar.

import { type ColourMap, cividis, css, signed } from '../charts/colourmaps'
import type { OptionalNumber, Snapshot } from '../state/answers'
import type { Options } from '../state/options'
import { h } from '../widgets/dom'
import { sig } from '../widgets/format'

export interface LegColours {
  colours: string[]
  label: string
  low: number
  high: number
  map: ColourMap
}

/** What the legs are coloured by, and the mode that is chosen, -1 for none. */
export type Chosen = Pick<Options, 'colour' | 'mode'>

export const COLOURS = [
  ['force', 'Legs: force'],
  ['energy', 'Legs: energy'],
  ['strain', 'Legs: strain in mode'],
  ['plain', 'Legs: plain'],
] as const

/** The chosen quantity of each leg and its name; null where it does not exist. */
function quantity(s: Snapshot, { colour, mode }: Chosen): [OptionalNumber[] | null, string] {
  if (colour === 'force') return [s.legs.force, 'static force, N (+ compression)']
  if (colour === 'energy') return [s.legs.energy, 'static strain energy, J']
  if (colour === 'strain') return [s.strain[mode] ?? null, `strain energy share, mode ${mode + 1}`]
  return [null, '']
}

/** What to do where legs have no colours. */
function missing({ colour, mode }: Chosen): string {
  if (colour === 'plain') return ''
  return colour === 'strain' && mode < 0
    ? 'choose a mode to see its strain energy by leg'
    : 'not available at this pose'
}

export function legColours(s: Snapshot, chosen: Chosen, dark: boolean): LegColours | null {
  const [values, label] = quantity(s, chosen)
  if (!values || values.some((v) => v === null)) return null
  const numbers = values as number[]
  const most = Math.max(...numbers.map(Math.abs)) || 1
  const both = chosen.colour === 'force' && Math.min(...numbers) < 0
  const [low, high] = both ? [-most, most] : [0, most]
  const darkest = dark ? 0.22 : 0 // what is darker cannot be seen on a dark background
  const sequential: ColourMap = (t) => cividis(darkest + (1 - darkest) * t)
  const map = both ? signed : sequential
  return { colours: numbers.map((v) => css(map((v - low) / (high - low)))), label, low, high, map }
}

export function colourBar(): { element: HTMLElement; show(shown: LegColours | null, chosen: Chosen): void } {
  const strip = h('canvas', { width: 128, height: 1, 'aria-hidden': 'true' })
  const [low, high, label] = [h('span'), h('span'), h('span', { class: 'label' })]
  const element = h('div', { class: 'legend' }, label, h('div', { class: 'strip' }, low, strip, high))
  return {
    element,
    show(shown, chosen) {
      element.querySelector<HTMLElement>('.strip')!.hidden = !shown
      if (!shown) label.textContent = missing(chosen)
      if (!shown) return
      const context = strip.getContext('2d')!
      for (let i = 0; i < 128; i++) {
        context.fillStyle = css(shown.map(i / 127))
        context.fillRect(i, 0, 1, 1)
      }
      low.textContent = sig(shown.low, 3)
      high.textContent = sig(shown.high, 3)
      label.textContent = shown.label
    },
  }
}
