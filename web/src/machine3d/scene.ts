// The 3-D view: renderer, camera and views. It is drawn only when something has changed.

import * as THREE from 'three'
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js'
import type { Theme } from '../charts/look'
import { h, perFrame } from '../widgets/dom'
import { saveCanvas, saveText } from '../widgets/download'
import { Machine } from './machine'
import { dispose } from './parts'

export type Standard = 'iso' | 'front' | 'side' | 'top'

const DIRECTIONS: Record<Standard, [number, number, number]> = {
  iso: [0.75, -1, 0.55],
  front: [0, -1, 0.02],
  side: [1, 0, 0.02],
  top: [0, -0.001, 1],
}

interface Graphics {
  kind: 'none' | 'software' | 'hardware'
  parameters: THREE.WebGLRendererParameters
}

/** Whether WebGL works, and whether in hardware. A context in software is costly to make, so it is kept for use. */
function graphics(): Graphics {
  const canvas = document.createElement('canvas')
  const context = canvas.getContext('webgl2', { antialias: false, alpha: true })
  if (!context) return { kind: 'none', parameters: {} }
  const info = context.getExtension('WEBGL_debug_renderer_info')
  const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER))
  if (/swiftshader|llvmpipe|software|basic render/i.test(name))
    return { kind: 'software', parameters: { canvas, context } }
  context.getExtension('WEBGL_lose_context')?.loseContext()
  return { kind: 'hardware', parameters: { antialias: true } }
}

export class Scene {
  readonly element = h('div', { class: 'scene' })
  readonly machine: Machine
  private readonly graphics = graphics()
  private readonly world = new THREE.Scene()
  private readonly camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100)
  private readonly light = new THREE.DirectionalLight(0xffffff, 2.2)
  private readonly sky = new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.6)
  private readonly grid = new THREE.Group()
  private renderer: THREE.WebGLRenderer | null = null
  private controls: OrbitControls | null = null
  private readonly sizes = new ResizeObserver(() => this.resize())
  private frames = 0
  readonly draw = perFrame(() => this.render())

  /** `theme`: the colours of what it stands in. */
  constructor(private readonly theme: () => Theme) {
    this.machine = new Machine(theme)
    this.camera.up.set(0, 0, 1)
    this.light.position.set(2, -3, 5)
    this.world.add(this.sky, this.light, this.light.target, this.grid, this.machine.root)
    if (this.graphics.kind === 'none' || !this.begin()) {
      this.element.append(
        h(
          'p',
          { class: 'notice' },
          'This browser shows no 3-D (WebGL is missing). The tables and plots work all the same.',
        ),
      )
    }
  }

  private begin(): boolean {
    try {
      this.renderer = new THREE.WebGLRenderer({ ...this.graphics.parameters, alpha: true })
    } catch {
      return false
    }
    const canvas = this.renderer.domElement
    canvas.tabIndex = 0
    canvas.setAttribute('role', 'img')
    canvas.setAttribute('aria-label', 'The hexapod in 3-D. Arrow keys turn it, plus and minus zoom.')
    this.element.append(canvas)
    this.controls = new OrbitControls(this.camera, canvas)
    this.controls.enableDamping = false
    this.controls.addEventListener('change', this.draw)
    this.controls.addEventListener('end', () => this.tellView())
    canvas.addEventListener('keydown', (event) => this.key(event))
    canvas.addEventListener('webglcontextrestored', this.draw)
    this.sizes.observe(this.element)
    return true
  }

  /** Leave the wheel to what the view lies in, unless the view has the focus. */
  shareWheel(): void {
    const { renderer, controls } = this
    if (!renderer || !controls) return
    controls.enableZoom = false
    for (const [event, on] of [['focus', true] as const, ['blur', false] as const])
      renderer.domElement.addEventListener(event, () => {
        controls.enableZoom = on
      })
  }

  /** Give back what the browser has few of. */
  dispose(): void {
    this.sizes.disconnect()
    this.controls?.dispose()
    dispose(this.world)
    this.renderer?.dispose()
    this.renderer?.forceContextLoss()
    this.renderer = null
  }

  private key(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    }
    const offset = this.camera.position.clone().sub(this.controls!.target)
    const round = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y))
    if (event.key in turns) {
      round.theta += 0.12 * turns[event.key][0]
      round.phi = Math.min(Math.max(round.phi + 0.12 * turns[event.key][1], 0.01), Math.PI - 0.01)
    } else if (event.key === '+' || event.key === '=') round.radius /= 1.15
    else if (event.key === '-') round.radius *= 1.15
    else return
    event.preventDefault()
    const back = new THREE.Vector3().setFromSpherical(round)
    this.camera.position.copy(this.controls!.target).add(new THREE.Vector3(back.x, -back.z, back.y))
    this.controls!.update()
    this.tellView()
    this.draw()
  }

  /** Called with the new view when a person has turned the camera: where it stands and where it looks. */
  turned: (view: string) => void = () => undefined

  private tellView(): void {
    const { position } = this.camera
    const { target } = this.controls!
    const six = [...position.toArray(), ...target.toArray()].map((v) => Number(v.toPrecision(5)))
    this.turned(six.join(','))
  }

  /** Look from a standard direction, with the whole machine in view; or from a place to a place, as six numbers. */
  look(view: string): void {
    const places = view.split(',').map(Number)
    const given = places.length === 6
    if (given && this.seen(places)) return
    this.resize() // the size of now, which is told later
    const from = given ? 'iso' : (view as Standard)
    const points = this.machine.extent()
    const middle = new THREE.Box3().setFromPoints(points)
    const centre = middle.getCenter(new THREE.Vector3())
    const radius = this.machine.radius
    const distance = this.distance(points, centre, from)
    this.camera.near = distance / 50
    this.camera.far = distance * 10
    this.camera.position.copy(centre).addScaledVector(new THREE.Vector3(...DIRECTIONS[from]).normalize(), distance)
    this.camera.updateProjectionMatrix()
    this.controls?.target.copy(centre)
    if (given) this.stand(places)
    this.controls?.update()
    this.light.position.copy(centre).add(new THREE.Vector3(0.6, -1, 1.6).multiplyScalar(4 * radius))
    this.light.target.position.copy(centre)
    this.draw()
  }

  /** Put the camera at the first three numbers, looking at the others. */
  private stand(places: number[]): void {
    this.camera.position.fromArray(places)
    this.controls?.target.fromArray(places, 3)
  }

  /** Whether the camera stands there already, to five digits. */
  private seen(places: number[]): boolean {
    const off = this.camera.position.distanceTo(new THREE.Vector3(...places.slice(0, 3)))
    return off < 1e-4 * this.camera.position.length()
  }

  /** How far away the camera must be to have all points in view. */
  private distance(points: THREE.Vector3[], centre: THREE.Vector3, from: Standard): number {
    const back = new THREE.Vector3(...DIRECTIONS[from]).normalize()
    const right = new THREE.Vector3(0, 0, 1).cross(back).normalize()
    const up = back.clone().cross(right)
    const half = Math.tan((this.camera.fov * Math.PI) / 360) / 1.12
    return points.reduce((most, point) => {
      const p = point.clone().sub(centre)
      return Math.max(
        most,
        p.dot(back) + Math.max(Math.abs(p.dot(up)) / half, Math.abs(p.dot(right)) / (half * this.camera.aspect)),
      )
    }, 0)
  }

  /** The floor under the base, with grid lines at a power of ten of a metre. */
  paintGround(): void {
    const step = 10 ** Math.floor(Math.log10(this.machine.radius * 0.6))
    const t = this.theme()
    const lines = new THREE.GridHelper(step * 20, 20, t.grid, t.grid)
    lines.rotation.x = Math.PI / 2
    const z = -0.2 * this.machine.radius
    lines.position.z = z
    this.grid.clear()
    this.grid.add(lines)
    this.draw()
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element
    if (!this.renderer || !clientWidth || !clientHeight) return
    this.renderer.setPixelRatio(
      this.graphics.kind === 'software' ? Math.min(1, devicePixelRatio) : Math.min(2, devicePixelRatio),
    )
    this.renderer.setSize(clientWidth, clientHeight, false)
    this.camera.aspect = clientWidth / clientHeight
    this.camera.updateProjectionMatrix()
    this.machine.labelSize = (24 / clientHeight) * 2 * Math.tan((this.camera.fov * Math.PI) / 360)
    this.render()
  }

  private render(): void {
    if (!this.renderer) return
    this.renderer.render(this.world, this.camera)
    this.element.dataset.frames = String(++this.frames)
  }

  /** The view as a picture, with its background. */
  savePng(name: string): void {
    this.world.background = new THREE.Color(this.theme().paper)
    this.render()
    if (this.renderer) saveCanvas(name, this.renderer.domElement)
    this.world.background = null
    this.draw()
  }

  /** The view as lines and faces; the drawing code is loaded when first wanted. */
  async saveSvg(name: string): Promise<void> {
    const { vectorView } = await import('./vector')
    const { clientWidth, clientHeight } = this.element
    saveText(
      `${name}.svg`,
      vectorView(this.world, this.camera, [clientWidth || 800, clientHeight || 600], this.theme().paper),
      'image/svg+xml',
    )
  }
}
