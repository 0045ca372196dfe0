// The state of this page.

import type { Design, JointModel, PoseBox, Snapshot } from './answers'

export const COLOURS = ['plain', 'force', 'energy', 'strain'] as const

export interface Page {
  preset: string // name of a packaged design, '' for another text
  text: string
  changes: Record<string, unknown>
  pose: number[] // m, degrees
  joint: JointModel
  mode: number // 0 to 5, -1 for none
  colour: (typeof COLOURS)[number]
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

  /** What every request to the server contains. */
  question(): { design: string; changes: Record<string, unknown>; pose: number[]; joint: JointModel } {
    const { text, changes, pose, joint } = this.page
    return { design: text, changes, pose, joint }
  }
}

/** Identifies a design: its text and the changes to it. */
export const sourceKey = (text: string, changes: Record<string, unknown>): string =>
  `${JSON.stringify(changes)} ${text}`

export const store = new Store()
export const page = store.page
