// The six inputs of the pose. The page's state holds the pose; the inputs show and change it.

import { COORDINATES } from '../state/answers'
import { page, store } from '../state/store'
import { button, freshId, h, select } from '../widgets/dom'
import { field, parsed } from '../widgets/format'

const isLength = (i: number) => i < 3
const factor = (i: number) => (isLength(i) && page.unit === 'mm' ? 1000 : 1)
const unit = (i: number) => (isLength(i) ? page.unit : '°')
const NAMES = ['x', 'y', 'z', 'roll', 'pitch', 'yaw']

export function setPose(pose: number[]): void {
  store.set({ pose: [...pose] })
}

function setOne(i: number, value: number): void {
  const pose = [...page.pose]
  pose[i] = value
  store.set({ pose })
}

interface Row {
  element: HTMLElement
  show(): void
}

function row(i: number): Row {
  const id = freshId('pose')
  const name = COORDINATES[i]
  const slider = h('input', { type: 'range', step: 'any', 'aria-label': `${name} slider`, tabindex: 0 })
  const number = h('input', {
    type: 'text',
    inputmode: 'decimal',
    id,
    class: 'number',
    autocomplete: 'off',
    spellcheck: 'false',
  })
  const suffix = h('span', { class: 'unit' })
  let typing = false // answers do not replace a number that is being typed
  const put = () => {
    typing = false
    const value = parsed(number.value)
    const good = Number.isFinite(value)
    number.setAttribute('aria-invalid', String(!good))
    if (good) setOne(i, value / factor(i))
  }
  slider.addEventListener('input', () => {
    const [low, high] = [page.box.low[i], page.box.high[i]]
    const steps = (high - low) / 1000
    const power = 10 ** Math.floor(Math.log10(steps || 1))
    setOne(i, Number((Math.round(Number(slider.value) / power) * power).toPrecision(12)))
  })
  slider.addEventListener('keydown', (event) => {
    const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key]
    if (!way) return
    event.preventDefault()
    const step = (page.box.high[i] - page.box.low[i]) / 200
    setOne(i, Math.min(Math.max(page.pose[i] + way * step, page.box.low[i]), page.box.high[i]))
  })
  number.addEventListener('input', () => (typing = true))
  number.addEventListener('change', put)
  number.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') put()
  })
  const element = h('div', { class: 'row' }, h('label', { for: id }, NAMES[i]), slider, number, suffix)
  return {
    element,
    show() {
      const [low, high] = [page.box.low[i], page.box.high[i]]
      slider.min = String(low)
      slider.max = String(high)
      slider.value = String(page.pose[i])
      const shown = field(page.pose[i] * factor(i))
      slider.setAttribute('aria-valuetext', `${shown} ${unit(i)}`)
      if (!typing && (document.activeElement !== number || parsed(number.value) !== parsed(shown))) number.value = shown
      number.removeAttribute('aria-invalid')
      const outside = page.pose[i] < low - 1e-12 || page.pose[i] > high + 1e-12
      element.classList.toggle('outside', outside)
      suffix.textContent = unit(i)
    },
  }
}

export function posePanel(): HTMLElement {
  const rows = COORDINATES.map((_, i) => row(i))
  const show = () => {
    for (const row of rows) row.show()
  }
  const units = select(
    'Unit of lengths',
    [
      ['mm', 'mm'],
      ['m', 'm'],
    ] as const,
    page.unit,
    (value) => store.set({ unit: value }),
  )
  const home = button('Home', () => page.design && setPose(page.design.home), {
    title: 'Move to the home pose (H)',
    class: 'quiet',
  })
  store.on(['pose', 'unit', 'box', 'design'], () => {
    units.set(page.unit)
    show()
  })
  return h(
    'section',
    { 'aria-labelledby': 'pose-title', class: 'block' },
    h(
      'div',
      { class: 'bar' },
      h('h2', { id: 'pose-title' }, 'Pose'),
      h('span', { class: 'spring' }),
      home,
      units.element,
    ),
    ...rows.map((r) => r.element),
  )
}
