// The workspace: cloud of index against cond(H), slice heat map, worst pose. Clicking any of them moves the machine.

import { floats } from '../state/api'
import { Cloud } from '../charts/scatter'
import { onTheme } from '../charts/colours'
import { button, freshId, h, select, settled } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { count, duration, field, parsed, sig } from '../widgets/format'
import { Heat, type Grid } from '../charts/heatmap'
import { setPose } from './pose'
import { Runner } from '../widgets/job'
import { page, store } from '../state/store'
import { COORDINATES, type Coordinate } from '../state/answers'

const POSE_HEAD = ['x_m', 'y_m', 'z_m', 'roll_deg', 'pitch_deg', 'yaw_deg']
const unitOf = (c: Coordinate) => (COORDINATES.indexOf(c) < 3 ? 'm' : '°')
/** Poses come as float32: nine digits hold one, and twice as many would only look exact. */
const tidy = (six: number[]) => six.map((v) => Number(Number(v).toPrecision(9)))

function boxTable(): HTMLElement {
  const inputs = COORDINATES.map((c, i) =>
    (['low', 'high'] as const).map((side) => {
      const input = h('input', {
        type: 'text',
        class: 'number',
        inputmode: 'decimal',
        'aria-label': `${side === 'low' ? 'Least' : 'Greatest'} ${c}, ${unitOf(c)}`,
      })
      input.addEventListener('change', () => {
        const value = parsed(input.value)
        if (!Number.isFinite(value)) return show()
        const box = { low: [...page.box.low], high: [...page.box.high] }
        box[side][i] = value
        store.set({ box })
      })
      return input
    }),
  )
  const show = () =>
    inputs.forEach(([low, high], i) => {
      low.value = field(page.box.low[i] ?? 0)
      high.value = field(page.box.high[i] ?? 0)
      const wrong = page.box.low[i] > page.box.high[i]
      for (const input of [low, high]) input.setAttribute('aria-invalid', String(wrong))
    })
  store.on(['box'], show)
  return h(
    'details',
    { class: 'fold' },
    h('summary', {}, 'Pose box'),
    h(
      'table',
      { class: 'data narrow' },
      h(
        'thead',
        {},
        h('tr', {}, h('th', { scope: 'col' }, ''), h('th', { scope: 'col' }, 'from'), h('th', { scope: 'col' }, 'to')),
      ),
      h(
        'tbody',
        {},
        ...COORDINATES.map((c, i) =>
          h(
            'tr',
            {},
            h('th', { scope: 'row' }, `${c}, ${unitOf(c)}`),
            h('td', {}, inputs[i][0]),
            h('td', {}, inputs[i][1]),
          ),
        ),
      ),
    ),
    button('Box of the design', () => page.design && store.set({ box: page.design.box }), { class: 'quiet' }),
  )
}

interface Part {
  element: HTMLElement
  fresh(): void
}

function cloudPart(): Part {
  const summary = h('div', { class: 'scroll' })
  const cloud = new Cloud((point) => setPose(tidy(point.six)))
  const runner = new Runner()
  const points = select(
    'Number of poses',
    ([10_000, 100_000, 300_000, 1_000_000] as const).map((n) => [String(n), `${count(n)} poses`] as const),
    '100000',
    () => run(),
  )
  const scale = select(
    'Axis of the index',
    [
      ['linear', 'linear'],
      ['log', 'logarithmic'],
    ] as const,
    'linear',
    (kind) => (cloud.logarithmic = kind === 'log'),
  )
  const seed = h('input', { type: 'text', class: 'number tiny', value: '1', inputmode: 'numeric', id: freshId('seed') })
  const summarise = () => {
    const order = cloud.order()
    if (!order.length) return summary.replaceChildren()
    const pick: [string, number][] = [
      ['lowest', 0],
      ['5 %', 0.05],
      ['median', 0.5],
      ['95 %', 0.95],
      ['highest', 1],
    ]
    summary.replaceChildren(
      h(
        'table',
        { class: 'data', id: 'cloud-table' },
        h('caption', { class: 'hidden' }, 'Poses of the cloud by index'),
        h('thead', {}, h('tr', {}, ...['index', 'ω₁ rad/s', 'cond(H)', ''].map((t) => h('th', { scope: 'col' }, t)))),
        h(
          'tbody',
          {},
          ...pick.map(([name, share]) => {
            const p = cloud.point(order[Math.round(share * (order.length - 1))])
            return h(
              'tr',
              {},
              h('th', { scope: 'row' }, name),
              h('td', {}, sig(p.index)),
              h('td', {}, sig(p.condition)),
              h(
                'td',
                {},
                button('Go', () => setPose(tidy(p.six)), {
                  class: 'quiet',
                  'aria-label': `Move the machine to the pose of the ${name} index`,
                }),
              ),
            )
          }),
        ),
      ),
    )
  }
  const run = async () => {
    const total = Number(points.element.value)
    const began = performance.now()
    cloud.begin(total)
    const whole = await runner.run(
      'cloud',
      { ...store.question(), box: page.box, points: total, seed: Math.max(0, Math.round(parsed(seed.value)) || 0) },
      (message, data) => {
        if (message.type === 'points') cloud.add(floats(data))
      },
    )
    if (whole) runner.say(`${count(cloud.size)} poses in ${duration((performance.now() - began) / 1000)}`)
    if (cloud.size) summarise()
    element.dataset.points = String(cloud.size)
  }
  store.on(['snapshot'], () => cloud.mark(page.snapshot?.index ?? null, page.snapshot?.condition ?? null))
  onTheme(cloud.draw)
  seed.addEventListener('change', () => void run())
  const worst = worstPart()
  const csv = () => saveCsv('workspace', [...POSE_HEAD, 'index_rad_s', 'cond_h'], cloud.rows())
  const element = h(
    'section',
    { 'aria-label': 'Cloud of poses', class: 'card', id: 'cloud' },
    h(
      'div',
      { class: 'bar' },
      h('h3', {}, 'Index against cond(H)'),
      h('span', { class: 'spring' }),
      csvButton('Cloud', csv),
      figureButtons(
        () => 'workspace',
        'Cloud',
        () => cloud.figure(),
      ),
    ),
    h(
      'div',
      { class: 'bar tools' },
      points.element,
      h('label', { for: seed.id }, 'seed'),
      seed,
      scale.element,
      button('Run', () => void run()),
      worst.button,
    ),
    runner.element,
    worst.element,
    cloud.element,
    summary,
  )
  return { element, fresh: () => void run() }
}

/** Finds the least index in the box and moves the machine there. */
function worstPart(): { button: HTMLElement; element: HTMLElement } {
  const runner = new Runner()
  const element = h('div', { id: 'worst', hidden: true }, runner.element)
  const find = button(
    'Worst pose',
    () => {
      element.hidden = false
      void runner.run('worst', { ...store.question(), box: page.box }, (message) => {
        if (message.type !== 'found') return
        setPose(message.pose as number[])
        setTimeout(() => runner.say(message.words as string))
      })
    },
    { title: 'Find the lowest index in the box and move there' },
  )
  return { button: find, element }
}

function slicePart(): Part {
  const heat = new Heat((x, y) => {
    const pose = [...page.pose]
    pose[COORDINATES.indexOf(drawn.across)] = Number(x.toPrecision(6))
    pose[COORDINATES.indexOf(drawn.up)] = Number(y.toPrecision(6))
    moved = true
    setPose(pose)
  })
  let drawn: { across: Coordinate; up: Coordinate } = { across: 'x', up: 'y' }
  let moved = false // by a click in this map, which then stays valid
  const runner = new Runner()
  const options = COORDINATES.map((c) => [c, c] as const)
  const across = select('Coordinate across', options, 'x', () => void run())
  const up = select('Coordinate up', options, 'y', () => void run())
  const what = select(
    'Quantity',
    [
      ['0', 'index ω₁'],
      ['1', 'cond(H)'],
    ] as const,
    '0',
    () => heat.shown && heat.show(heat.shown, Number(what.element.value)),
  )
  const scale = (c: Coordinate) => {
    const i = COORDINATES.indexOf(c)
    return { label: `${c}, ${unitOf(c)}`, min: page.box.low[i], max: page.box.high[i] }
  }
  const run = async () => {
    const [a, u] = [across.element.value as Coordinate, up.element.value as Coordinate]
    const side = 120
    const values = new Float32Array(3 * side * side).fill(Number.NaN)
    const grid: Grid = { side, x: scale(a), y: scale(u), values }
    let at = 0
    const whole = await runner.run(
      'slice',
      { ...store.question(), box: page.box, across: a, up: u, side },
      (message, data) => {
        if (message.type !== 'rows') return
        const part = floats(data)
        values.set(part, at)
        at += part.length
        drawn = { across: a, up: u }
        heat.show(grid, Number(what.element.value))
        mark()
      },
    )
    if (whole)
      runner.say(`${count(side * side)} poses; the other four coordinates are the machine's. Paler: beyond the limits.`)
  }
  const mark = () => heat.mark(page.pose[COORDINATES.indexOf(drawn.across)], page.pose[COORDINATES.indexOf(drawn.up)])
  const csv = () => {
    const grid = heat.shown
    if (!grid) return
    const place = (s: Grid['x'], i: number) => s.min + (i * (s.max - s.min)) / (grid.side - 1)
    const rows = Array.from({ length: grid.side ** 2 }, (_, i) => [
      place(grid.x, i % grid.side),
      place(grid.y, Math.floor(i / grid.side)),
      ...grid.values.subarray(3 * i, 3 * i + 3),
    ])
    saveCsv('slice', [drawn.across, drawn.up, 'index_rad_s', 'cond_h', 'within_limits'], rows)
  }
  const again = settled(250, () => visible(element) && void run())
  store.on(['pose'], () => {
    mark()
    if (moved) moved = false
    else if (heat.shown) again()
  })
  onTheme(heat.draw)
  const element = h(
    'section',
    { 'aria-label': 'Slice of the workspace', class: 'card', id: 'slice' },
    h(
      'div',
      { class: 'bar' },
      h('h3', {}, 'Slice at the pose'),
      h('span', { class: 'spring' }),
      csvButton('Slice', csv),
      figureButtons(
        () => 'slice',
        'Slice',
        () => heat.figure(),
      ),
    ),
    h(
      'div',
      { class: 'bar tools' },
      what.element,
      h('span', {}, 'over'),
      across.element,
      h('span', {}, 'and'),
      up.element,
    ),
    runner.element,
    heat.element,
  )
  return { element, fresh: () => void run() }
}

const visible = (element: HTMLElement) => element.offsetParent !== null

export function workspacePanel(): HTMLElement {
  const parts = [cloudPart(), slicePart()]
  let stale = true
  const now = () => {
    if (!stale || !visible(element) || !page.design) return
    stale = false
    for (const part of parts) part.fresh()
  }
  const refresh = settled(350, now)
  store.on(['design', 'joint', 'box'], () => {
    stale = true
    refresh()
  })
  store.on(['tab'], () => requestAnimationFrame(now))
  const element = h('div', {}, boxTable(), ...parts.map((p) => p.element))
  return element
}
