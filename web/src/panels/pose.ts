// The pose. The page's state holds it; the inputs show and change it.

import { poseRows } from '../snapshot/pose-rows'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { spring } from '../widgets/layout'

const UNITS = [
  ['mm', 'mm'],
  ['m', 'm'],
] as const

export function setPose(pose: number[]): void {
  store.set({ pose: [...pose] })
}

export function posePanel(): HTMLElement {
  const { elements, show } = poseRows({
    pose: () => page.pose,
    box: () => page.box,
    unit: () => page.unit,
    put: setPose,
  })
  const units = choose('unit', 'Unit of lengths', UNITS)
  const home = button('Home', () => page.design && setPose(page.design.home), {
    title: 'Move to the home pose (H)',
    class: 'quiet',
  })
  store.on(['pose', 'unit', 'box', 'design'], show)
  const title = h('h2', { id: 'pose-title' }, 'Pose')
  const bar = h('div', { class: 'bar' }, title, spring(), home, units)
  return h('section', { 'aria-labelledby': 'pose-title', class: 'block' }, bar, ...elements)
}
