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

  /** Play a motion for a view; another view's motion ends. */
  play(owner: string, motion: Motion): void {
    const running = this.motion !== null
    if (this.owner !== owner) this.began = performance.now()
    this.owner = owner
    this.motion = motion
    if (this.still.matches) this.stillPicture()
    else if (!running) requestAnimationFrame(this.step)
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

  /** For users who prefer reduced motion: the largest displacement, without motion. */
  private stillPicture(): void {
    this.scene.machine.place(...this.motion!(0.25))
    this.motion = null
    this.scene.draw()
  }
}
