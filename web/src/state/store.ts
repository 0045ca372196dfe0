// The state of this page, and its address: everything a shared link restores.

import type { PoseBox, Design, Snapshot } from './answers'

export interface Page {
  preset: string // name of a packaged design, '' for another text
  text: string
  changes: Record<string, unknown>
  pose: number[] // m, degrees
  joint: 'universal' | 'spin_free'
  mode: number // 0 to 5, -1 for none
  colour: 'plain' | 'force' | 'energy' | 'strain'
  tab: string
  unit: 'mm' | 'm'
  box: PoseBox
  design: Design | null
  described: string // which text and changes `design` describes
  snapshot: Snapshot | null
  error: string
}

type Key = keyof Page
type Listener = () => void

class Store {
  readonly page: Page = {
    preset: '',
    text: '',
    changes: {},
    pose: [0, 0, 0, 0, 0, 0],
    joint: 'universal',
    mode: -1,
    colour: 'force',
    tab: 'modes',
    unit: 'mm',
    box: { low: [], high: [] },
    design: null,
    described: '',
    snapshot: null,
    error: '',
  }
  private readonly listeners: [Key[], Listener][] = []

  on(keys: Key[], listener: Listener): void {
    this.listeners.push([keys, listener])
  }

  set(patch: Partial<Page>): void {
    Object.assign(this.page, patch)
    const changed = Object.keys(patch) as Key[]
    for (const [keys, listener] of this.listeners) if (keys.some((key) => changed.includes(key))) listener()
  }

  /** What every question to the server carries. */
  question(): { design: string; changes: Record<string, unknown>; pose: number[]; joint: string } {
    const { text, changes, pose, joint } = this.page
    return { design: text, changes, pose, joint }
  }
}

/** Tells designs of the page apart. */
export const sourceKey = (text: string, changes: Record<string, unknown>): string =>
  `${JSON.stringify(changes)} ${text}`

export const store = new Store()
export const page = store.page

/** The page's state as the part of an address behind #. Presets go by name, other designs whole. */
export async function toAddress(): Promise<string> {
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

/** State from an address; what it does not say or says wrongly stays as it is. */
export async function fromAddress(hash: string, presets: Record<string, string>): Promise<Partial<Page>> {
  const part = new URLSearchParams(hash.replace(/^#/, ''))
  const found: Partial<Page> = {}
  const preset = part.get('design') ?? ''
  const toml = part.get('toml')
  if (preset in presets) Object.assign(found, { preset, text: presets[preset] })
  else if (toml) Object.assign(found, { preset: '', text: await unpacked(toml) })
  const pose = numbers(part.get('pose'), 6)
  if (pose) found.pose = pose
  const box = numbers(part.get('box'), 12)
  if (box) found.box = { low: box.slice(0, 6), high: box.slice(6) }
  if (part.get('joint') === 'spin_free') found.joint = 'spin_free'
  if (part.get('unit') === 'm') found.unit = 'm'
  const mode = Number(part.get('mode') ?? 0)
  if (mode >= 1 && mode <= 6) found.mode = mode - 1
  const colour = part.get('colour')
  if (colour && ['plain', 'force', 'energy', 'strain'].includes(colour)) found.colour = colour as Page['colour']
  const tab = part.get('tab')
  if (tab) found.tab = tab
  try {
    const changes = JSON.parse(part.get('changes') ?? '{}')
    if (changes && typeof changes === 'object' && !Array.isArray(changes)) found.changes = changes
  } catch {
    // an address cut short by a mail program: the rest of it still counts
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
