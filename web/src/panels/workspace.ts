// The workspace: pose box, cloud of poses with the worst one, and a slice. They are computed when they are seen.

import { h } from '../widgets/dom'
import { CloudPart } from './cloud'
import { boxTable } from './pose-box'
import { SlicePart } from './slice'

export function workspacePanel(): HTMLElement {
  return h(
    'div',
    {},
    h('h2', { class: 'hidden' }, 'Workspace'),
    boxTable(),
    new CloudPart().element,
    new SlicePart().element,
  )
}
