// Motions of the drawn machine: a mode, the shaken base, a simulation played back. One at a time.

import type { Scene } from './scene'
import { noTwist, type Twist } from './twist'

/** The displacements of platform and base at a time since the motion began, s. */
export type Motion = (seconds: number) => [Twist, Twist]

export class Animation {
  private motion: Motion | null = null
  private began = 0
  private owner = ''
  private readonly still = matchMedia('(prefers-reduced-motion: reduce)')

  constructor(private readonly scene: Scene) {}

  /** Whether this computer asks for reduced motion: nothing moves then unless a person starts it. */
  get reduced(): boolean {
    return this.still.matches
  }

  /** Play a motion for a view; another view's motion ends. */
  play(owner: string, motion: Motion): void {
    const running = this.motion !== null
    if (this.owner !== owner) this.began = performance.now()
    this.owner = owner
    this.motion = motion
    if (!running) requestAnimationFrame(this.step)
  }

  /** Show one displacement, without motion. */
  hold(owner: string, shown: [Twist, Twist]): void {
    this.owner = owner
    this.motion = null
    this.scene.machine.place(...shown)
    this.scene.draw()
  }

  /** Play a motion; where reduced motion is asked for, show its greatest displacement, a quarter of a swing. */
  swing(owner: string, motion: Motion, swings: number): void {
    if (this.reduced) this.hold(owner, motion(0.25 / swings))
    else this.play(owner, motion)
  }

  stop(owner?: string): void {
    if (owner && owner !== this.owner) return
    this.owner = ''
    this.motion = null
    this.scene.machine.place(noTwist(), noTwist())
    this.scene.draw()
  }

  private readonly step = (): void => {
    if (!this.motion) return
    this.scene.machine.place(...this.motion((performance.now() - this.began) / 1000))
    this.scene.draw()
    requestAnimationFrame(this.step)
  }
}
