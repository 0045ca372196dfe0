// The workspace: pose box, cloud of poses with the worst one, and a slice. They are computed when they are seen.

import { page, store } from '../state/store'
import { h, settled } from '../widgets/dom'
import { CloudPart } from './cloud'
import { boxTable } from './pose-box'
import { SlicePart } from './slice'

export function workspacePanel(): HTMLElement {
  const parts = [new CloudPart(), new SlicePart()]
  const element = h('div', {}, boxTable(), ...parts.map((part) => part.element))
  let stale = true
  const now = () => {
    if (!stale || !element.offsetParent || !page.design) return
    stale = false
    for (const part of parts) void part.run()
  }
  const refresh = settled(350, now)
  store.on(['design', 'joint', 'box'], () => {
    stale = true
    refresh()
  })
  store.on(['tab'], () => requestAnimationFrame(now))
  return element
}
