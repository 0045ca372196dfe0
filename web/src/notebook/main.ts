// The module of the widget that `flexapod.view` makes. Each place where it is shown has a shadow tree of its own: the
// notebook's styles end there, and so do those of the view.

import common from '../widgets/common.css?inline'
import { h } from '../widgets/dom'
import { type Model, Shared } from './model'
import own from './style.css?inline'
import { followSurroundings } from './surroundings'
import { View } from './view'

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const host = h('div', { class: 'flexapod-view', 'data-lm-suppress-shortcuts': 'true' }) // keys are for the sliders
  const root = host.attachShadow({ mode: 'open' })
  root.append(h('style', {}, common, own))
  el.append(host)
  let view: View | null = null
  const leave = followSurroundings(el, host, () => {
    if (!view) {
      view = new View(new Shared(model), host)
      root.append(view.element)
      view.begin()
      view.look('iso')
    } else view.begin()
  })
  return () => {
    leave()
    view?.dispose()
    host.remove()
  }
}

export default { render }
