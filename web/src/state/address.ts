// The state of the page as an address: everything a shared link restores.

import { OPTION_KEYS, OPTIONS, type Options, ruleOf, sixNumbers } from './options'
import type { Page } from './store'

const OWN_PARTS = ['design', 'toml', 'changes', 'pose', 'box'] // beside the options

/** What an address holds, and in words what is wrong in it. */
export interface Found {
  state: Partial<Page>
  faults: string[]
}

/** The page's state as the part of an address behind #. Presets go by name, other designs whole. */
export async function toAddress(page: Page): Promise<string> {
  const part = new URLSearchParams()
  if (page.preset) part.set('design', page.preset)
  else part.set('toml', await packed(page.text))
  if (Object.keys(page.changes).length) part.set('changes', JSON.stringify(page.changes))
  part.set('pose', page.pose.join(','))
  if (page.design && JSON.stringify(page.box) !== JSON.stringify(page.design.box))
    part.set('box', [...page.box.low, ...page.box.high].join(','))
  for (const key of OPTION_KEYS) {
    const { initial, write } = ruleOf(key)
    const value = write(page[key])
    if (value !== write(initial) || key === 'tab') part.set(key, value)
  }
  return part.toString().replace(/%2C/g, ',')
}

/** The state that an address holds; options that it leaves out are as at first. */
export async function fromAddress(hash: string, presets: Record<string, string>): Promise<Found> {
  const part = new URLSearchParams(hash.replace(/^#/, ''))
  const faults: string[] = []
  const state: Partial<Page> = { changes: {}, ...options(part, faults) }
  Object.assign(state, await design(part, presets, faults), changes(part, faults))
  const pose = part.get('pose')
  if (pose !== null) {
    const six = sixNumbers(pose)
    if (six) state.pose = six
    else faults.push(`its pose, “${short(pose)}”, is not six numbers`)
  }
  const box = part.get('box')
  if (box !== null) {
    const sides = box.split(',')
    const [low, high] = [sixNumbers(sides.slice(0, 6).join()), sixNumbers(sides.slice(6).join())]
    if (low && high) state.box = { low, high }
    else faults.push(`its box, “${short(box)}”, is not twelve numbers`)
  }
  for (const key of new Set(part.keys()))
    if (!OWN_PARTS.includes(key) && !(key in OPTIONS)) faults.push(`“${short(key)}” is nothing that this page knows`)
  return { state, faults }
}

/** Every option as the address has it. */
function options(part: URLSearchParams, faults: string[]): Options {
  const found: Partial<Record<keyof Options, unknown>> = {}
  for (const key of OPTION_KEYS) {
    const { initial, read, words } = ruleOf(key)
    const text = part.get(key)
    const value = text === null ? initial : read(text)
    if (value === undefined) faults.push(`${key} is “${short(text ?? '')}”; it must be ${words}`)
    found[key] = value ?? initial
  }
  return found as Options
}

/** The design of an address: a preset's name or a text. */
async function design(
  part: URLSearchParams,
  presets: Record<string, string>,
  faults: string[],
): Promise<Partial<Page>> {
  const [preset, toml] = [part.get('design'), part.get('toml')]
  if (preset !== null) {
    if (Object.hasOwn(presets, preset)) return { preset, text: presets[preset] }
    faults.push(`there is no design “${short(preset)}” here; there are ${Object.keys(presets).join(', ')}`)
  } else if (toml !== null) {
    const text = await unpacked(toml)
    if (text !== null) return { preset: '', text }
    faults.push('the design in it is damaged, as when a link is cut short')
  }
  return {}
}

function changes(part: URLSearchParams, faults: string[]): Partial<Page> {
  const text = part.get('changes')
  if (text === null) return {}
  try {
    const found = JSON.parse(text)
    if (found && typeof found === 'object' && !Array.isArray(found)) return { changes: found }
  } catch {
    // told below: the address was cut short, by a mail program for instance
  }
  faults.push('the changes to the design in it are damaged, and left out')
  return {}
}

const short = (text: string): string => (text.length > 40 ? `${text.slice(0, 40)}…` : text)

async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'))
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer())
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''))
    .replace(/\+/g, '-')
    .replace(/\//g, '_')
    .replace(/=+$/, '')
}

async function unpacked(text: string): Promise<string | null> {
  try {
    const bytes = Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')), (c) => c.charCodeAt(0))
    return await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text()
  } catch {
    return null
  }
}
