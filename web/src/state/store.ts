// The state of this page.

import type { Design, JointModel, PoseBox, Snapshot } from './answers'
import { initialOptions, type Options } from './options'

export interface Page extends Options {
  preset: string // name of a packaged design, '' for another text
  text: string
  changes: Record<string, unknown>
  pose: number[] // m, degrees
  box: PoseBox
  design: Design | null
  described: string // which text and changes `design` describes
  snapshot: Snapshot | null
  error: string
  away: boolean // the server does not answer
}

type Key = keyof Page
type Listener = () => void

/** What a request to the server is about. */
export type Question = Record<string, unknown>

/** A machine, in every request. */
export interface MachineQuestion extends Question {
  design: string
  changes: Record<string, unknown>
  joint: JointModel
}

class Store {
  readonly page: Page = {
    ...initialOptions(),
    preset: '',
    text: '',
    changes: {},
    pose: [0, 0, 0, 0, 0, 0],
    box: { low: [], high: [] },
    design: null,
    described: '',
    snapshot: null,
    error: '',
    away: false,
  }
  private readonly listeners: [Key[] | null, Listener][] = []

  on(keys: Key[], listener: Listener): void {
    this.listeners.push([keys, listener])
  }

  /** Listen to every change. */
  onAny(listener: Listener): void {
    this.listeners.push([null, listener])
  }

  set(patch: Partial<Page>): void {
    Object.assign(this.page, patch)
    const changed = Object.keys(patch) as Key[]
    for (const [keys, listener] of this.listeners)
      if (keys === null || keys.some((key) => changed.includes(key))) listener()
  }

  /** What a request about the machine at any pose contains. */
  machine(): MachineQuestion {
    const { text, changes, joint } = this.page
    return { design: text, changes, joint }
  }

  /** What a request about the machine at its pose contains. */
  question(): MachineQuestion & { pose: number[] } {
    return { ...this.machine(), pose: this.page.pose }
  }
}

/** Identifies a design: its text and the changes to it. */
export const sourceKey = (text: string, changes: Record<string, unknown>): string =>
  `${JSON.stringify(changes)} ${text}`

export const store = new Store()
export const page = store.page
