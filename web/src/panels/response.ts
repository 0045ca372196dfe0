// Frequency response: how the platform follows the base, forces or leg commands; and the base shaken, in 3-D.

import { ask, Live, Refused } from '../state/api'
import { twist, type Animation } from '../machine3d/animation'
import { categories, DASHES, onTheme } from '../charts/colours'
import { button, freshId, h, select, settled, status, svg } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { field, parsed, sig } from '../widgets/format'
import { LinePlot, span, type Lines } from '../charts/lines'
import { page, store } from '../state/store'
import { COORDINATES } from '../state/answers'

interface Answer {
  omega: number[]
  magnitude: (number | null)[][][] // output, input, frequency
  phase: (number | null)[][][] // degrees
  outputs: string[]
  inputs: string[]
  output_units: string[]
  input_units: string[]
  modes: { name: string; omega: number }[]
}

interface Shaken {
  platform: { real: number[]; imag: number[] }
  base: number[]
  ratio: number | null
  reach: number
}

const TURN = 2 * Math.PI

export function responsePanel(animation: Animation): HTMLElement {
  let answer: Answer | null = null
  const note = status({ class: 'hint' })
  const what = select(
    'Response',
    [
      ['absolute', 'Transmissibility: motion by base motion'],
      ['relative', 'Motion relative to the base'],
      ['compliance', 'Compliance: motion by wrench'],
      ['command', 'Motion by leg command'],
      ['leg_force', 'Leg force by base motion'],
    ] as const,
    'absolute',
    () => live.request(),
  )
  const layout = select(
    'Panels',
    [
      ['all', 'One panel per output'],
      ['one', 'One large panel'],
      ['phase', 'One large panel, phase'],
    ] as const,
    'all',
    () => show(),
  )
  const output = select(
    'Output',
    COORDINATES.map((c, i) => [String(i), c] as const),
    '2',
    () => show(),
  )
  const hertz = select(
    'Frequency axis',
    [
      ['Hz', 'Hz'],
      ['rad', 'rad/s'],
    ] as const,
    'Hz',
    () => show(),
  )
  const loss = h('input', {
    type: 'text',
    class: 'number tiny',
    value: '0',
    id: freshId('loss'),
    inputmode: 'decimal',
    title: 'Structural damping of the legs, K (1 + iη)',
  })
  loss.addEventListener('change', () => live.request())
  const grid = h('div', { class: 'panels' })
  const plots = COORDINATES.map(
    () =>
      new LinePlot(
        () => (layout.element.value === 'all' ? 190 : 430),
        (x) => shakeAt(x),
      ),
  )
  for (const plot of plots) plot.legend = false
  grid.append(...plots.map((p) => p.element))

  const request = () => ({ ...store.question(), quantity: what.element.value, loss_factor: parsed(loss.value) })
  const live = new Live<Answer>(
    'api/response',
    request,
    (a) => {
      answer = a
      show()
    },
    (error) => (note.textContent = error.message),
  )

  const scale = () => (hertz.element.value === 'Hz' ? 1 / TURN : 1)
  const lines = (a: Answer, o: number, phase: boolean): Lines => {
    const k = scale()
    const values = (phase ? a.phase : a.magnitude)[o]
    const [min, max] = phase ? [-190, 190] : span(values, true)
    const units = [...new Set(a.input_units)].map((u) => `${a.output_units[o]}/${u}`.replace(/^(\S+)\/\1$/, '1'))
    return {
      title: `${a.outputs[o]} (${a.output_units[o]}) ${phase ? 'phase' : 'amplitude'}`,
      x: {
        label: `frequency, ${hertz.element.value === 'Hz' ? 'Hz' : 'rad/s'}`,
        min: a.omega[0] * k,
        max: a.omega[a.omega.length - 1] * k,
        log: true,
      },
      y: phase
        ? { label: `${a.outputs[o]}: phase, °`, min, max }
        : { label: `${a.outputs[o]}, ${units.join(' or ')}`, min, max, log: true },
      at: a.omega.map((w) => w * k),
      series: a.inputs.map((name, i) => ({ name, colour: categories()[i], dash: DASHES[i], values: values[i] })),
      marks: a.modes.map((m) => ({ at: m.omega * k, name: m.name })),
    }
  }
  const keys = h('div', { class: 'bar tools keys', role: 'group', 'aria-label': 'Lines shown' })
  let keyed = ''
  const drawKeys = (names: string[]) => {
    if (keyed === names.join()) return
    keyed = names.join()
    keys.replaceChildren(
      h('span', { class: 'hint' }, 'by'),
      ...names.map((name, i) => {
        const sample = svg(
          'svg',
          { width: 22, height: 8, 'aria-hidden': 'true' },
          svg('line', {
            x1: 0,
            x2: 22,
            y1: 4,
            y2: 4,
            stroke: categories()[i],
            'stroke-width': 2.5,
            'stroke-dasharray': DASHES[i].join(' '),
          }),
        )
        const key = h('button', { type: 'button', class: 'key', 'aria-pressed': 'true' }, sample, name)
        key.addEventListener('click', () => {
          const on = key.getAttribute('aria-pressed') !== 'true'
          key.setAttribute('aria-pressed', String(on))
          for (const plot of plots) plot.reveal(name, on)
        })
        return key
      }),
    )
  }
  const show = () => {
    if (!answer) return
    note.textContent = ''
    drawKeys(answer.inputs)
    const one = layout.element.value !== 'all'
    output.element.hidden = !one
    grid.classList.toggle('one', one)
    const chosen = Number(output.element.value)
    plots.forEach((plot, i) => {
      plot.element.hidden = one && i > 0
      if (!plot.element.hidden) plot.show(lines(answer!, one ? chosen : i, layout.element.value === 'phase'))
    })
    ;[...output.element.options].forEach((option, i) => (option.textContent = answer!.outputs[i]))
  }
  const refresh = settled(60, () => element.offsetParent && live.request())
  store.on(['snapshot'], refresh)
  store.on(['tab'], () => {
    requestAnimationFrame(refresh)
    if (page.tab !== 'response') animation.stop('shake')
  })
  onTheme(() => {
    keyed = ''
    show()
    plots.forEach((p) => p.build())
  })

  const shaker = shakePart(animation, () => page.tab === 'response')
  const shakeAt = (x: number) => shaker.at(x / scale() / TURN)
  const chosenPlot = () => plots.find((p) => p.ready && !p.element.hidden)!
  const figure = () =>
    layout.element.value === 'all' ? panelsFigure(plots.map((p) => p.figure())) : chosenPlot().figure()
  const csv = () => {
    if (!answer) return
    const a = answer
    const head = [
      'omega_rad_s',
      'frequency_hz',
      ...a.outputs.flatMap((o) => a.inputs.flatMap((i) => [`${o}_by_${i}_amplitude`, `${o}_by_${i}_phase_deg`])),
    ]
    saveCsv(
      `response-${what.element.value}`,
      head,
      a.omega.map((w, n) => [
        w,
        w / TURN,
        ...a.outputs.flatMap((_, o) => a.inputs.flatMap((__, i) => [a.magnitude[o][i][n], a.phase[o][i][n]])),
      ]),
    )
  }
  const element = h(
    'div',
    { id: 'response' },
    h(
      'div',
      { class: 'bar' },
      h('h2', {}, 'Frequency response'),
      h('span', { class: 'spring' }),
      csvButton('Response', csv),
      figureButtons(() => `response-${what.element.value}`, 'Response', figure),
    ),
    h(
      'div',
      { class: 'bar tools' },
      what.element,
      layout.element,
      output.element,
      hertz.element,
      h('label', { for: loss.id }, 'loss factor'),
      loss,
    ),
    note,
    shaker.element,
    keys,
    grid,
    h(
      'p',
      { class: 'hint' },
      'Exact tangent at rest, with damping. Dotted lines: damped natural frequencies. Click a plot to shake the base there; drag across to zoom, double-click to see all; click a name above to hide its line.',
    ),
  )
  output.element.hidden = true
  return element
}

/** The base shaken at one frequency along one axis. */
function shakePart(animation: Animation, shown: () => boolean): { element: HTMLElement; at(hertz: number): void } {
  const frequency = h('input', {
    type: 'text',
    class: 'number',
    inputmode: 'decimal',
    id: freshId('shake'),
    'aria-label': 'Shaking frequency, Hz',
  })
  const axis = select(
    'Axis of the base',
    COORDINATES.map((c) => [c, c] as const),
    'z',
    () => void go(true),
  )
  const words = status({ class: 'hint', id: 'shake-words' })
  let on = false
  const toggle = button('Shake the base', () => void go(!on), { 'aria-pressed': 'false', id: 'shake' })
  const stop = () => {
    on = false
    animation.stop('shake')
    paint()
  }
  const paint = () => {
    toggle.textContent = on ? 'Stop' : 'Shake the base'
    toggle.setAttribute('aria-pressed', String(on))
  }
  const go = async (start: boolean) => {
    if (!start) return stop()
    const hertz = parsed(frequency.value)
    if (!(hertz > 0)) {
      words.textContent = `The frequency is ${frequency.value || 'empty'}; give a number of Hz above 0.`
      return
    }
    try {
      const s = await ask<Shaken>('api/shake', { ...store.question(), omega: TURN * hertz, axis: axis.element.value })
      if (page.mode >= 0) store.set({ mode: -1 })
      on = true
      paint()
      const speed = 0.7
      animation.play('shake', (t) => {
        const [c, n] = [Math.cos(TURN * speed * t), Math.sin(TURN * speed * t)]
        const moved = s.platform.real.map((re, i) => re * c - s.platform.imag[i] * n)
        return [twist(moved, s.reach), twist(s.base, s.reach * c)]
      })
      words.textContent = `At ${sig(hertz, 4)} Hz the platform's ${axis.element.value} moves ${sig(s.ratio, 3)} times as far as the base's. Drawn larger and ${sig(hertz / speed, 3)} times slower.`
    } catch (error) {
      if (!(error instanceof Refused)) throw error
      words.textContent = error.message
    }
  }
  store.on(['snapshot'], () => {
    const first = page.snapshot?.damped?.frequency[0] ?? page.snapshot?.frequency[0]
    if (!frequency.value && first) frequency.value = field(Number((0.97 * first).toPrecision(4)))
    if (on && shown()) void go(true)
  })
  store.on(['tab', 'mode'], () => (on && (!shown() || page.mode >= 0) ? stop() : undefined))
  frequency.addEventListener('change', () => void go(true))
  return {
    element: h(
      'div',
      {},
      h(
        'div',
        { class: 'bar tools' },
        toggle,
        h('span', {}, 'along'),
        axis.element,
        h('span', {}, 'at'),
        frequency,
        h('span', {}, 'Hz'),
      ),
      words,
    ),
    at(hertz) {
      frequency.value = field(Number(hertz.toPrecision(5)))
      void go(true)
    },
  }
}

/** Several figures as one, two side by side. */
function panelsFigure(figures: SVGSVGElement[]): SVGSVGElement {
  const whole = figures[0].cloneNode(false) as SVGSVGElement
  const [w, height] = [760, 460]
  whole.setAttribute('viewBox', `0 0 ${2 * w} ${3 * height}`)
  whole.setAttribute('width', String(2 * w))
  whole.setAttribute('height', String(3 * height))
  figures.forEach((figure, i) => {
    figure.setAttribute('x', String((i % 2) * w))
    figure.setAttribute('y', String(Math.floor(i / 2) * height))
    whole.append(figure)
  })
  return whole
}
