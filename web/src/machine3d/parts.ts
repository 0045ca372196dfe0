// Parts of the drawn machine: plates, joints, frames, labels.

import * as THREE from 'three'
import type { Theme } from '../charts/look'

const Y = new THREE.Vector3(0, 1, 0)
const AXES: [string, THREE.Vector3, number][] = [
  ['x', new THREE.Vector3(1, 0, 0), 0xd55e00],
  ['y', new THREE.Vector3(0, 1, 0), 0x009e73],
  ['z', new THREE.Vector3(0, 0, 1), 0x0072b2],
]

export type Phong = THREE.MeshPhongMaterial

export function phong(colour: THREE.ColorRepresentation, more: THREE.MeshPhongMaterialParameters = {}): Phong {
  return new THREE.MeshPhongMaterial({ color: colour, specular: 0x222222, shininess: 24, ...more })
}

/** A prism over the joints, in the order of their angle about z. */
export function plate(joints: THREE.Vector3[], thickness: number, material: THREE.Material): THREE.Mesh {
  const middle = joints.reduce((sum, j) => sum.add(j), new THREE.Vector3()).divideScalar(joints.length)
  const ring = [...joints].sort(
    (a, b) => Math.atan2(a.y - middle.y, a.x - middle.x) - Math.atan2(b.y - middle.y, b.x - middle.x),
  )
  const grown = ring.map((j) => j.clone().sub(middle).multiplyScalar(1.1).add(middle))
  const points: number[] = []
  const push = (...vs: THREE.Vector3[]) => points.push(...vs.flatMap((v) => [v.x, v.y, v.z]))
  const at = (v: THREE.Vector3, z: number) => new THREE.Vector3(v.x, v.y, v.z + z)
  const [top, bottom] = thickness > 0 ? [thickness, 0] : [0, thickness]
  grown.forEach((a, i) => {
    const b = grown[(i + 1) % grown.length]
    push(at(middle, top), at(a, top), at(b, top))
    push(at(middle, bottom), at(b, bottom), at(a, bottom))
    push(at(a, bottom), at(b, bottom), at(b, top), at(a, bottom), at(b, top), at(a, top))
  })
  const geometry = new THREE.BufferGeometry()
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3))
  geometry.computeVertexNormals()
  return new THREE.Mesh(geometry, material)
}

/** Text that faces the viewer and keeps its size on the screen. */
export function label(text: string, colour: string, halo: string): THREE.Sprite {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 64
  const context = canvas.getContext('2d')!
  context.font = '600 44px system-ui, sans-serif'
  context.textAlign = 'center'
  context.textBaseline = 'middle'
  context.lineJoin = 'round'
  context.lineWidth = 11
  context.strokeStyle = halo
  context.strokeText(text, 32, 34) // it is read on dark and on bright legs
  context.fillStyle = colour
  context.fillText(text, 32, 34)
  const texture = new THREE.CanvasTexture(canvas)
  texture.colorSpace = THREE.SRGBColorSpace
  const sprite = new THREE.Sprite(
    new THREE.SpriteMaterial({ map: texture, sizeAttenuation: false, depthTest: false, depthWrite: false }),
  )
  sprite.renderOrder = 10
  sprite.userData.label = text
  sprite.userData.colour = colour
  sprite.userData.halo = halo
  return sprite
}

/** A universal joint: a pin along its axis in the base. */
export function pin(at: THREE.Vector3, axis: THREE.Vector3, r: number, material: THREE.Material): THREE.Mesh {
  const mesh = new THREE.Mesh(new THREE.CylinderGeometry(0.75 * r, 0.75 * r, 4.2 * r, 12), material)
  mesh.quaternion.setFromUnitVectors(Y, axis.clone().normalize())
  mesh.position.copy(at)
  return mesh
}

/** The axes x, y, z as arrows of radius `r` with their names. */
export function frame(length: number, r: number, { text, paper }: Theme): THREE.Object3D[] {
  return AXES.flatMap(([name, direction, colour]) => {
    const more = { emissive: colour, emissiveIntensity: 0.35, depthTest: false, transparent: true }
    const material = phong(colour, more)
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(r, r, length, 8), material)
    const tip = new THREE.Mesh(new THREE.ConeGeometry(3 * r, 9 * r, 12), material)
    for (const part of [shaft, tip]) part.quaternion.setFromUnitVectors(Y, direction)
    shaft.position.copy(direction).multiplyScalar(length / 2)
    tip.position.copy(direction).multiplyScalar(length)
    shaft.renderOrder = tip.renderOrder = 4 // seen through the plates
    const sign = label(name, text, paper)
    sign.position.copy(direction).multiplyScalar(length + 20 * r)
    return [shaft, tip, sign]
  })
}

/** The platform's mass centre, labelled G; `size` of the machine, m. */
export function massCentre(at: THREE.Vector3, size: number, { text, paper }: Theme): THREE.Object3D[] {
  const more = { emissive: 0x5a3d00, depthTest: false, transparent: true, opacity: 0.95 }
  const ball = new THREE.Mesh(new THREE.SphereGeometry(0.045 * size, 20, 14), phong(0xe69f00, more))
  ball.renderOrder = 5
  ball.position.copy(at)
  const sign = label('G', text, paper)
  sign.position.copy(at).add(new THREE.Vector3(0, 0, 0.12 * size))
  return [ball, sign]
}

/** Free the memory of everything below an object. */
export function dispose(root: THREE.Object3D): void {
  root.traverse((item) => {
    if (item instanceof THREE.Mesh) {
      item.geometry.dispose()
      ;(item.material as THREE.Material).dispose()
    } else if (item instanceof THREE.Sprite) {
      item.material.map?.dispose()
      item.material.dispose()
    }
  })
}
