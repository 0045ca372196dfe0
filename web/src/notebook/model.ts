// The state that a view shares with the kernel, and with other views of the same machine.

import type { Drawn, Snapshot } from '../state/answers'

/** The model of a widget, as anywidget gives it. */
export interface Model {
  get(name: string): unknown
  set(name: string, value: unknown): void
  save_changes(): void
  on(event: string, listener: () => void): void
  off(event: string, listener: () => void): void
}

/** Traits of the widget in Python (flexapod.notebook.machine_view). */
export interface Traits {
  _drawn: Drawn
  /** The pose that is asked for, m and degrees. */
  _six: number[]
  /** The machine at the last pose that it could take. */
  _snapshot: Snapshot
  /** A pose that it cannot take, and why. */
  _refused: { pose: number[]; words: string } | null
  /** The mode that moves, from 1. */
  mode: number | null
}

export class Shared {
  private readonly heard: [string, () => void][] = []

  constructor(private readonly model: Model) {}

  get<K extends keyof Traits>(name: K): Traits[K] {
    return this.model.get(name) as Traits[K]
  }

  put<K extends keyof Traits>(name: K, value: Traits[K]): void {
    this.model.set(name, value)
    this.model.save_changes()
  }

  on(names: (keyof Traits)[], listener: () => void): void {
    for (const name of names) {
      this.model.on(`change:${name}`, listener)
      this.heard.push([`change:${name}`, listener])
    }
  }

  /** Whether the machine that is shown is at the pose that is asked for. */
  get answered(): boolean {
    return this.asked(this.get('_snapshot').pose)
  }

  /** Why the machine cannot take the pose that is asked for; '' where it can, or is not asked yet. */
  get refusal(): string {
    const refused = this.get('_refused')
    return refused && this.asked(refused.pose) ? refused.words : ''
  }

  private asked(pose: number[]): boolean {
    return this.get('_six').every((value, i) => value === pose[i])
  }

  /** Listen no more. */
  leave(): void {
    for (const [event, listener] of this.heard) this.model.off(event, listener)
  }
}
