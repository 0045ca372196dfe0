// The hexapod as meshes: plates, legs of two parts, joints, frames, mass centre. It draws what the server computed.

import * as THREE from 'three'
import { EXCEEDED, theme } from '../charts/colours'
import type { Geometry } from '../state/answers'

/** Displacement of a rigid body for an animation: along (m) and about (rad) the inertial axes. */
export interface Twist {
  along: THREE.Vector3
  about: THREE.Vector3
}

export const noTwist = (): Twist => ({ along: new THREE.Vector3(), about: new THREE.Vector3() })

const Y = new THREE.Vector3(0, 1, 0)
const vector = (v: number[]) => new THREE.Vector3(v[0], v[1], v[2])

function phong(
  colour: THREE.ColorRepresentation,
  more: THREE.MeshPhongMaterialParameters = {},
): THREE.MeshPhongMaterial {
  return new THREE.MeshPhongMaterial({ color: colour, specular: 0x222222, shininess: 24, ...more })
}

/** A prism over the joints, taken in the order of their angle about z. */
function plate(joints: THREE.Vector3[], thickness: number, material: THREE.Material): THREE.Mesh {
  const middle = joints.reduce((sum, j) => sum.add(j), new THREE.Vector3()).divideScalar(joints.length)
  const ring = [...joints].sort(
    (a, b) => Math.atan2(a.y - middle.y, a.x - middle.x) - Math.atan2(b.y - middle.y, b.x - middle.x),
  )
  const grown = ring.map((j) => j.clone().sub(middle).multiplyScalar(1.1).add(middle))
  const points: number[] = []
  const push = (...vs: THREE.Vector3[]) => vs.forEach((v) => points.push(v.x, v.y, v.z))
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
function label(text: string, colour: string): THREE.Sprite {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 64
  const context = canvas.getContext('2d')!
  context.font = '600 44px system-ui, sans-serif'
  context.textAlign = 'center'
  context.textBaseline = 'middle'
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
  return sprite
}

interface Leg {
  lower: THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhongMaterial>
  upper: THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhongMaterial>
  warning: THREE.Mesh
  number: THREE.Sprite
}

export class Machine {
  readonly root = new THREE.Group()
  radius = 1
  private readonly base = new THREE.Group()
  private readonly platform = new THREE.Group()
  private legs: Leg[] = []
  private labels: THREE.Sprite[] = []
  private joints: { base: THREE.Vector3[]; platform: THREE.Vector3[] } = { base: [], platform: [] }
  private readonly rest = { position: new THREE.Vector3(), turn: new THREE.Quaternion() }
  private readonly masses = new THREE.Vector3()
  private lowerLength = 1
  private size = 1
  private key = ''
  private exceeded: boolean[] = []
  private colours: string[] = []
  private moved: [Twist, Twist] = [noTwist(), noTwist()]
  labelsShown = true
  private labelScale = 0.02

  constructor() {
    this.root.add(this.base, this.platform)
  }

  /** Show a pose; rebuilds the meshes only where the design is another one. Returns whether it was. */
  show(geometry: Geometry, legAtHome: number): boolean {
    const key = JSON.stringify([
      geometry.base,
      geometry.platform,
      geometry.axes,
      geometry.mass_center,
      legAtHome,
      theme().dark,
    ])
    const rebuilt = key !== this.key
    if (rebuilt) this.build(geometry, legAtHome)
    this.key = key
    const m = geometry.matrix
    this.rest.position.copy(vector(geometry.position))
    const matrix = new THREE.Matrix4().set(
      m[0][0],
      m[0][1],
      m[0][2],
      0,
      m[1][0],
      m[1][1],
      m[1][2],
      0,
      m[2][0],
      m[2][1],
      m[2][2],
      0,
      0,
      0,
      0,
      1,
    )
    this.rest.turn.setFromRotationMatrix(matrix)
    this.place(...this.moved)
    return rebuilt
  }

  /** The outermost points of the machine as it stands. */
  extent(): THREE.Vector3[] {
    const up = this.joints.platform.map((p) =>
      p.clone().multiplyScalar(1.2).applyQuaternion(this.rest.turn).add(this.rest.position),
    )
    return [
      ...this.joints.base.map((p) => p.clone().multiplyScalar(1.15)),
      ...up,
      this.masses.clone().applyQuaternion(this.rest.turn).add(this.rest.position),
    ]
  }

  /** Displace platform and base from the pose shown. */
  place(platform: Twist, base: Twist): void {
    this.moved = [platform, base]
    move(this.base, new THREE.Vector3(), new THREE.Quaternion(), base)
    move(this.platform, this.rest.position, this.rest.turn, platform)
    this.legs.forEach((leg, i) => {
      const from = this.joints.base[i].clone().applyQuaternion(this.base.quaternion).add(this.base.position)
      const to = this.joints.platform[i].clone().applyQuaternion(this.platform.quaternion).add(this.platform.position)
      this.placeLeg(leg, from, to)
    })
  }

  private placeLeg(leg: Leg, from: THREE.Vector3, to: THREE.Vector3): void {
    const along = to.clone().sub(from)
    const length = along.length()
    along.divideScalar(length || 1)
    const turn = new THREE.Quaternion().setFromUnitVectors(Y, along)
    leg.lower.quaternion.copy(turn)
    leg.upper.quaternion.copy(turn)
    leg.warning.quaternion.copy(turn)
    const lower = Math.min(this.lowerLength, 0.92 * length)
    leg.lower.scale.y = lower
    leg.lower.position.copy(from).addScaledVector(along, lower / 2)
    leg.upper.scale.y = length - 0.6 * lower
    leg.upper.position.copy(to).addScaledVector(along, -(length - 0.6 * lower) / 2)
    leg.warning.position.copy(from).addScaledVector(along, lower)
    leg.number.position.copy(from).addScaledVector(along, 0.3 * length)
  }

  /** Colour each leg, and ring those beyond a limit. */
  paint(colours: string[], exceeded: boolean[]): void {
    this.colours = colours
    this.exceeded = exceeded
    this.legs.forEach((leg, i) => {
      leg.lower.material.color.set(colours[i])
      leg.upper.material.color.set(exceeded[i] ? EXCEEDED : colours[i])
      leg.warning.visible = exceeded[i]
    })
  }

  /** Size of the labels, in heights of the view. */
  set labelSize(size: number) {
    this.labelScale = size
    for (const item of this.labels) item.scale.setScalar(size)
  }

  showLabels(on: boolean): void {
    this.labelsShown = on
    for (const item of this.labels) item.visible = on
  }

  private build(geometry: Geometry, legAtHome: number): void {
    dispose(this.root)
    this.base.clear()
    this.platform.clear()
    this.root.clear()
    this.root.add(this.base, this.platform)
    this.labels = []
    this.joints = { base: geometry.base.map(vector), platform: geometry.platform.map(vector) }
    const span = Math.max(
      ...this.joints.base.map((v) => Math.hypot(v.x, v.y)),
      ...this.joints.platform.map((v) => Math.hypot(v.x, v.y)),
    )
    this.size = span
    this.lowerLength = 0.58 * legAtHome
    this.radius = 0.62 * Math.hypot(2 * span, legAtHome)
    const t = theme()
    const thickness = 0.06 * span
    this.base.add(plate(this.joints.base, -thickness, phong(t.dark ? 0x47525f : 0x9aa5b1)))
    this.platform.add(
      plate(this.joints.platform, thickness, phong(t.dark ? 0x7d93a8 : 0xb7c6d6, { transparent: true, opacity: 0.9 })),
    )
    this.frame(this.base, 0.45 * span, t.text)
    this.frame(this.platform, 0.38 * span, t.text)
    this.masses.copy(vector(geometry.mass_center))
    this.massCentre(this.masses, t)
    this.buildLegs(geometry, t.dark)
    this.showLabels(this.labelsShown)
    this.labelSize = this.labelScale
    if (this.colours.length) this.paint(this.colours, this.exceeded)
  }

  private buildLegs(geometry: Geometry, dark: boolean): void {
    const r = 0.034 * this.size
    const tube = new THREE.CylinderGeometry(r, r, 1, 18)
    const rod = new THREE.CylinderGeometry(0.58 * r, 0.58 * r, 1, 14)
    const ball = new THREE.SphereGeometry(1.35 * r, 16, 10)
    const ring = new THREE.TorusGeometry(1.9 * r, 0.55 * r, 10, 24).rotateX(Math.PI / 2)
    const metal = phong(dark ? 0xa9b4c0 : 0x55606c)
    this.legs = geometry.base.map((_, i) => {
      const leg: Leg = {
        lower: new THREE.Mesh(tube, phong(0x888888)),
        upper: new THREE.Mesh(rod, phong(0x888888)),
        warning: new THREE.Mesh(ring, phong(EXCEEDED, { emissive: 0x7a3500 })),
        number: label(String(i + 1), theme().text),
      }
      leg.warning.visible = false
      this.root.add(leg.lower, leg.upper, leg.warning, leg.number)
      this.labels.push(leg.number)
      this.base.add(this.universal(this.joints.base[i], vector(geometry.axes[i]), r, metal))
      const joint = new THREE.Mesh(ball, metal)
      joint.position.copy(this.joints.platform[i])
      this.platform.add(joint)
      return leg
    })
  }

  /** A universal joint: a pin along its axis in the base. */
  private universal(at: THREE.Vector3, axis: THREE.Vector3, r: number, material: THREE.Material): THREE.Mesh {
    const pin = new THREE.Mesh(new THREE.CylinderGeometry(0.75 * r, 0.75 * r, 4.2 * r, 12), material)
    pin.quaternion.setFromUnitVectors(Y, axis.clone().normalize())
    pin.position.copy(at)
    return pin
  }

  private frame(to: THREE.Group, length: number, text: string): void {
    const axes: [string, THREE.Vector3, number][] = [
      ['x', new THREE.Vector3(1, 0, 0), 0xd55e00],
      ['y', new THREE.Vector3(0, 1, 0), 0x009e73],
      ['z', new THREE.Vector3(0, 0, 1), 0x0072b2],
    ]
    const r = 0.008 * this.size
    for (const [name, direction, colour] of axes) {
      const material = phong(colour, { emissive: colour, emissiveIntensity: 0.35, depthTest: false, transparent: true })
      const shaft = new THREE.Mesh(new THREE.CylinderGeometry(r, r, length, 8), material)
      const tip = new THREE.Mesh(new THREE.ConeGeometry(3 * r, 9 * r, 12), material)
      for (const part of [shaft, tip]) part.quaternion.setFromUnitVectors(Y, direction)
      shaft.position.copy(direction).multiplyScalar(length / 2)
      tip.position.copy(direction).multiplyScalar(length)
      shaft.renderOrder = tip.renderOrder = 4 // seen through the plates
      const name3d = label(name, text)
      name3d.position.copy(direction).multiplyScalar(length + 20 * r)
      this.labels.push(name3d)
      to.add(shaft, tip, name3d)
    }
  }

  private massCentre(at: THREE.Vector3, t: ReturnType<typeof theme>): void {
    const ball = new THREE.Mesh(
      new THREE.SphereGeometry(0.045 * this.size, 20, 14),
      phong(0xe69f00, { emissive: 0x5a3d00, depthTest: false, transparent: true, opacity: 0.95 }),
    )
    ball.renderOrder = 5
    ball.position.copy(at)
    const name = label('G', t.text)
    name.position.copy(at).add(new THREE.Vector3(0, 0, 0.12 * this.size))
    this.labels.push(name)
    this.platform.add(ball, name)
  }
}

function move(group: THREE.Group, position: THREE.Vector3, turn: THREE.Quaternion, twist: Twist): void {
  const angle = twist.about.length()
  const extra = new THREE.Quaternion()
  if (angle > 0) extra.setFromAxisAngle(twist.about.clone().divideScalar(angle), angle)
  group.position.copy(position).add(twist.along)
  group.quaternion.copy(extra.multiply(turn))
}

function dispose(root: THREE.Object3D): void {
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
