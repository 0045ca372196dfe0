// The 3-D view as SVG: faces painted from far to near, and labels as text.

import * as THREE from 'three'
import { svg } from '../widgets/dom'

interface Face {
  depth: number
  points: string
  fill: string
}

/** Faces of all meshes, lit by one direction, sorted by depth. */
export function vectorView(
  world: THREE.Scene,
  camera: THREE.PerspectiveCamera,
  [width, height]: [number, number],
  paper: string,
): string {
  const faces: Face[] = []
  const texts: SVGTextElement[] = []
  const light = new THREE.Vector3(0.4, -0.6, 1).normalize()
  world.updateMatrixWorld()
  const place = (p: THREE.Vector3) => {
    const q = p.clone().project(camera)
    return { x: ((q.x + 1) * width) / 2, y: ((1 - q.y) * height) / 2 }
  }
  world.traverseVisible((item) => {
    if (item instanceof THREE.Mesh) faces.push(...facesOf(item, camera, light, place))
    if (item instanceof THREE.Sprite && item.userData.label) {
      const { x, y } = place(item.getWorldPosition(new THREE.Vector3()))
      const look = {
        x: x.toFixed(1),
        y: (y + 4).toFixed(1),
        fill: item.userData.colour,
        stroke: item.userData.halo,
        'stroke-width': 4,
        'stroke-linejoin': 'round',
        'paint-order': 'stroke',
        'text-anchor': 'middle',
        'font-size': 14,
        'font-family': 'sans-serif',
        'font-weight': 600,
      }
      texts.push(svg('text', look, item.userData.label))
    }
  })
  faces.sort((a, b) => b.depth - a.depth)
  const figure = svg('svg', { xmlns: 'http://www.w3.org/2000/svg', viewBox: `0 0 ${width} ${height}`, width, height })
  figure.append(svg('rect', { width, height, fill: paper }))
  for (const face of faces)
    figure.append(svg('polygon', { points: face.points, fill: face.fill, stroke: face.fill, 'stroke-width': 0.4 }))
  figure.append(...texts)
  return new XMLSerializer().serializeToString(figure)
}

function facesOf(
  mesh: THREE.Mesh,
  camera: THREE.Camera,
  light: THREE.Vector3,
  place: (p: THREE.Vector3) => { x: number; y: number },
): Face[] {
  const found: Face[] = []
  const position = mesh.geometry.getAttribute('position')
  const index = mesh.geometry.getIndex()
  const total = index ? index.count : position.count
  const colour = (mesh.material as THREE.MeshPhongMaterial).color
  for (let i = 0; i < total; i += 3) {
    const corners = [0, 1, 2].map((k) =>
      new THREE.Vector3()
        .fromBufferAttribute(position, index ? index.getX(i + k) : i + k)
        .applyMatrix4(mesh.matrixWorld),
    )
    const normal = corners[1].clone().sub(corners[0]).cross(corners[2].clone().sub(corners[0])).normalize()
    const middle = corners[0].clone().add(corners[1]).add(corners[2]).divideScalar(3)
    const away = middle.clone().sub(camera.position)
    if (normal.dot(away) >= 0) continue
    const lit = 0.55 + 0.45 * Math.max(0, normal.dot(light))
    const points = corners
      .map(place)
      .map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`)
      .join(' ')
    found.push({ depth: away.length(), points, fill: `#${colour.clone().multiplyScalar(lit).getHexString()}` })
  }
  return found
}
