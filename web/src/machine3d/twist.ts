// Displacements of a rigid body, for animations.

import * as THREE from 'three'

/** A displacement along (m) and about (rad) the inertial axes. */
export interface Twist {
  along: THREE.Vector3
  about: THREE.Vector3
}

export const noTwist = (): Twist => ({ along: new THREE.Vector3(), about: new THREE.Vector3() })

/** Six numbers, times a factor, as a twist. */
export function twist(numbers: ArrayLike<number>, factor: number): Twist {
  return {
    along: new THREE.Vector3(numbers[0], numbers[1], numbers[2]).multiplyScalar(factor),
    about: new THREE.Vector3(numbers[3], numbers[4], numbers[5]).multiplyScalar(factor),
  }
}

/** How far a twist moves the farthest of some points given from the body's reference point, m. */
export function reach(numbers: number[], points: number[][]): number {
  const { along, about } = twist(numbers, 1)
  return Math.max(
    ...points.map(([x, y, z]) =>
      about
        .clone()
        .cross(new THREE.Vector3(x, y, z))
        .add(along)
        .length(),
    ),
  )
}

/** Place a body at its rest, displaced by a twist. */
export function place(body: THREE.Object3D, position: THREE.Vector3, turn: THREE.Quaternion, by: Twist): void {
  const angle = by.about.length()
  const extra = new THREE.Quaternion()
  if (angle > 0) extra.setFromAxisAngle(by.about.clone().divideScalar(angle), angle)
  body.position.copy(position).add(by.along)
  body.quaternion.copy(extra.multiply(turn))
}
