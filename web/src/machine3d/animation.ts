// Motions of the drawn machine: a mode, the shaken base, a simulation played back. One at a time.

import * as THREE from 'three'
import { noTwist, type Twist } from './machine'
import type { Scene } from './scene'

/** What moves: the twists of platform and base at a time of the page, s. */
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

  /** For people who asked for less motion: the end of the swing. */
  private stillPicture(): void {
    this.scene.machine.place(...this.motion!(0.25))
    this.motion = null
    this.scene.draw()
  }
}

export function twist(numbers: number[], factor: number): Twist {
  return {
    along: new THREE.Vector3(numbers[0], numbers[1], numbers[2]).multiplyScalar(factor),
    about: new THREE.Vector3(numbers[3], numbers[4], numbers[5]).multiplyScalar(factor),
  }
}

/** How far a twist moves the farthest of some points given from the body's reference point, m. */
export function reach(numbers: number[], points: number[][]): number {
  const along = new THREE.Vector3(numbers[0], numbers[1], numbers[2])
  const about = new THREE.Vector3(numbers[3], numbers[4], numbers[5])
  return Math.max(
    ...points.map((p) =>
      about
        .clone()
        .cross(new THREE.Vector3(p[0], p[1], p[2]))
        .add(along)
        .length(),
    ),
  )
}
