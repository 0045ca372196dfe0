// The state of the page as an address: everything a shared link restores.

import { JOINT_MODELS } from './answers'
import { COLOURS, type Page } from './store'

/** The page's state as the part of an address behind #. Presets go by name, other designs whole. */
export async function toAddress(page: Page): Promise<string> {
  const part = new URLSearchParams()
  if (page.preset) part.set('design', page.preset)
  else part.set('toml', await packed(page.text))
  if (Object.keys(page.changes).length) part.set('changes', JSON.stringify(page.changes))
  part.set('pose', page.pose.join(','))
  if (page.joint !== 'universal') part.set('joint', page.joint)
  if (page.mode >= 0) part.set('mode', String(page.mode + 1))
  if (page.colour !== 'force') part.set('colour', page.colour)
  if (page.unit !== 'mm') part.set('unit', page.unit)
  if (page.design && JSON.stringify(page.box) !== JSON.stringify(page.design.box))
    part.set('box', [...page.box.low, ...page.box.high].join(','))
  part.set('tab', page.tab)
  return part.toString().replace(/%2C/g, ',')
}

/** The state that an address holds, without what is missing or wrong in it. */
export async function fromAddress(hash: string, presets: Record<string, string>): Promise<Partial<Page>> {
  const part = new URLSearchParams(hash.replace(/^#/, ''))
  const found: Partial<Page> = await design(part, presets)
  const pose = numbers(part.get('pose'), 6)
  if (pose) found.pose = pose
  const box = numbers(part.get('box'), 12)
  if (box) found.box = { low: box.slice(0, 6), high: box.slice(6) }
  if (part.get('unit') === 'm') found.unit = 'm'
  const mode = Number(part.get('mode'))
  if ([1, 2, 3, 4, 5, 6].includes(mode)) found.mode = mode - 1
  const joint = JOINT_MODELS.find((name) => name === part.get('joint'))
  if (joint) found.joint = joint
  const colour = COLOURS.find((name) => name === part.get('colour'))
  if (colour) found.colour = colour
  const tab = part.get('tab')
  if (tab) found.tab = tab
  return found
}

/** The design of an address: a preset's name or a text, and changes to it. */
async function design(part: URLSearchParams, presets: Record<string, string>): Promise<Partial<Page>> {
  const found: Partial<Page> = {}
  const preset = part.get('design') ?? ''
  const toml = part.get('toml')
  if (preset in presets) Object.assign(found, { preset, text: presets[preset] })
  else if (toml) Object.assign(found, { preset: '', text: await unpacked(toml) })
  try {
    const changes = JSON.parse(part.get('changes') ?? '{}')
    if (changes && typeof changes === 'object' && !Array.isArray(changes)) found.changes = changes
  } catch {
    // the address was cut short, by a mail program for instance: the rest of it is used
  }
  return found
}

function numbers(text: string | null, length: number): number[] | null {
  const values = (text ?? '').split(',').map(Number)
  return text && values.length === length && values.every(Number.isFinite) ? values : null
}

async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'))
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer())
  return btoa(String.fromCharCode(...bytes))
    .replace(/\+/g, '-')
    .replace(/\//g, '_')
    .replace(/=+$/, '')
}

async function unpacked(text: string): Promise<string> {
  try {
    const bytes = Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')), (c) => c.charCodeAt(0))
    return await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text()
  } catch {
    return ''
  }
}
