// The hexapod as meshes: plates, legs of two parts, joints, frames, mass centre. It draws what the server computed.

import * as THREE from 'three'
import { EXCEEDED, type Theme } from '../charts/look'
import type { Geometry } from '../state/answers'
import { dispose, frame, label, massCentre, type Phong, phong, pin, plate } from './parts'
import { noTwist, place, type Twist } from './twist'

const Y = new THREE.Vector3(0, 1, 0)
const vector = (v: number[]) => new THREE.Vector3(v[0], v[1], v[2])

type Tube = THREE.Mesh<THREE.BufferGeometry, Phong>

interface Leg {
  lower: Tube
  upper: Tube
  warning: THREE.Mesh
  number: THREE.Sprite
}

export class Machine {
  readonly root = new THREE.Group()
  radius = 1
  labelsShown = true
  private readonly base = new THREE.Group()
  private readonly platform = new THREE.Group()
  private legs: Leg[] = []
  private joints: { base: THREE.Vector3[]; platform: THREE.Vector3[] } = { base: [], platform: [] }
  private readonly rest = { position: new THREE.Vector3(), turn: new THREE.Quaternion() }
  private readonly masses = new THREE.Vector3()
  private lowerLength = 1
  private size = 1
  private key = ''
  private exceeded: boolean[] = []
  private colours: string[] = []
  private moved: [Twist, Twist] = [noTwist(), noTwist()]
  private labelScale = 0.02

  constructor(private readonly theme: () => Theme) {
    this.root.add(this.base, this.platform)
  }

  /** Show a pose; the meshes are rebuilt only if the design is another one. Returns whether they were. */
  show(geometry: Geometry, legAtHome: number): boolean {
    const { base, platform, axes, mass_center } = geometry
    const key = JSON.stringify([base, platform, axes, mass_center, legAtHome, this.theme().dark])
    const rebuilt = key !== this.key
    if (rebuilt) this.build(geometry, legAtHome)
    this.key = key
    const [x, y, z] = geometry.matrix
    this.rest.position.copy(vector(geometry.position))
    const matrix = new THREE.Matrix4().set(x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, z[0], z[1], z[2], 0, 0, 0, 0, 1)
    this.rest.turn.setFromRotationMatrix(matrix)
    this.place(...this.moved)
    return rebuilt
  }

  /** The outermost points of the machine as it stands. */
  extent(): THREE.Vector3[] {
    const { position, turn } = this.rest
    const up = this.joints.platform.map((p) => p.clone().multiplyScalar(1.2).applyQuaternion(turn).add(position))
    const down = this.joints.base.map((p) => p.clone().multiplyScalar(1.15))
    return [...down, ...up, this.masses.clone().applyQuaternion(turn).add(position)]
  }

  /** Displace platform and base from the pose shown. */
  place(platform: Twist, base: Twist): void {
    this.moved = [platform, base]
    place(this.base, new THREE.Vector3(), new THREE.Quaternion(), base)
    place(this.platform, this.rest.position, this.rest.turn, platform)
    const on = (body: THREE.Object3D, p: THREE.Vector3) => p.clone().applyQuaternion(body.quaternion).add(body.position)
    this.legs.forEach((leg, i) => {
      this.placeLeg(leg, on(this.base, this.joints.base[i]), on(this.platform, this.joints.platform[i]))
    })
  }

  private placeLeg(leg: Leg, from: THREE.Vector3, to: THREE.Vector3): void {
    const along = to.clone().sub(from)
    const length = along.length()
    along.divideScalar(length || 1)
    const turn = new THREE.Quaternion().setFromUnitVectors(Y, along)
    for (const part of [leg.lower, leg.upper, leg.warning]) part.quaternion.copy(turn)
    const lower = Math.min(this.lowerLength, 0.92 * length)
    const upper = length - 0.6 * lower
    leg.lower.scale.y = lower
    leg.lower.position.copy(from).addScaledVector(along, lower / 2)
    leg.upper.scale.y = upper
    leg.upper.position.copy(to).addScaledVector(along, -upper / 2)
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
    for (const item of this.labels()) item.scale.setScalar(size)
  }

  showLabels(on: boolean): void {
    this.labelsShown = on
    for (const item of this.labels()) item.visible = on
  }

  private labels(): THREE.Object3D[] {
    const found: THREE.Object3D[] = []
    this.root.traverse((item) => {
      if (item instanceof THREE.Sprite) found.push(item)
    })
    return found
  }

  private build(geometry: Geometry, legAtHome: number): void {
    dispose(this.root)
    for (const group of [this.base, this.platform, this.root]) group.clear()
    this.root.add(this.base, this.platform)
    this.joints = { base: geometry.base.map(vector), platform: geometry.platform.map(vector) }
    this.size = Math.max(...[...this.joints.base, ...this.joints.platform].map((v) => Math.hypot(v.x, v.y)))
    this.lowerLength = 0.58 * legAtHome
    this.radius = 0.62 * Math.hypot(2 * this.size, legAtHome)
    this.masses.copy(vector(geometry.mass_center))
    this.buildPlates(this.theme())
    this.buildLegs(geometry.axes.map(vector), this.theme())
    this.showLabels(this.labelsShown)
    this.labelSize = this.labelScale
    if (this.colours.length) this.paint(this.colours, this.exceeded)
  }

  private buildPlates(look: Theme): void {
    const { dark } = look
    const size = this.size
    const [below, above] = [phong(dark ? 0x47525f : 0x9aa5b1), { transparent: true, opacity: 0.9 }]
    this.base.add(plate(this.joints.base, -0.06 * size, below), ...frame(0.45 * size, 0.008 * size, look))
    this.platform.add(
      plate(this.joints.platform, 0.06 * size, phong(dark ? 0x7d93a8 : 0xb7c6d6, above)),
      ...frame(0.38 * size, 0.008 * size, look),
      ...massCentre(this.masses, size, look),
    )
  }

  private buildLegs(axes: THREE.Vector3[], { dark, text, paper }: Theme): void {
    const r = 0.034 * this.size
    const tube = new THREE.CylinderGeometry(r, r, 1, 18)
    const rod = new THREE.CylinderGeometry(0.58 * r, 0.58 * r, 1, 14)
    const ball = new THREE.SphereGeometry(1.35 * r, 16, 10)
    const ring = new THREE.TorusGeometry(1.9 * r, 0.55 * r, 10, 24).rotateX(Math.PI / 2)
    const metal = phong(dark ? 0xa9b4c0 : 0x55606c)
    this.legs = axes.map((axis, i) => {
      const leg: Leg = {
        lower: new THREE.Mesh(tube, phong(0x888888)),
        upper: new THREE.Mesh(rod, phong(0x888888)),
        warning: new THREE.Mesh(ring, phong(EXCEEDED, { emissive: 0x7a3500 })),
        number: label(String(i + 1), text, paper),
      }
      leg.warning.visible = false
      this.root.add(leg.lower, leg.upper, leg.warning, leg.number)
      this.base.add(pin(this.joints.base[i], axis, r, metal))
      const joint = new THREE.Mesh(ball, metal)
      joint.position.copy(this.joints.platform[i])
      this.platform.add(joint)
      return leg
    })
  }
}
