// The six modes: table, the animated one, and what it is made of.

import type { Animation } from '../machine3d/animation'
import { reach, twist } from '../machine3d/animation'
import { categories } from '../charts/colours'
import { h } from '../widgets/dom'
import { csvButton, saveCsv } from '../widgets/download'
import { percent, sig } from '../widgets/format'
import { noTwist } from '../machine3d/machine'
import { page, store } from '../state/store'
import { COORDINATES } from '../state/answers'

const SWINGS = 0.7 // of the animation per second

function bars(label: string, names: readonly string[], shares: (number | null)[]): HTMLElement {
  return h(
    'table',
    { class: 'bars' },
    h('caption', {}, label),
    h(
      'tbody',
      {},
      ...names.map((name, i) => {
        const share = shares[i] ?? 0
        const bar = h('span', { class: 'fill' })
        bar.style.width = `${100 * Math.min(1, Math.max(0, share))}%`
        bar.style.background = categories()[i % 6]
        return h(
          'tr',
          {},
          h('th', { scope: 'row' }, name),
          h('td', { class: 'track' }, bar),
          h('td', { class: 'value' }, percent(shares[i])),
        )
      }),
    ),
  )
}

export function modesPanel(animation: Animation): HTMLElement {
  const body = h('tbody')
  const amplitude = h('input', { type: 'range', min: 0, max: 1, step: 'any', value: 0.35, id: 'amplitude' })
  const amplitudeText = h('output', { for: 'amplitude' })
  const detail = h('div', { class: 'detail' })
  const pick = (mode: number) => store.set({ mode: mode === page.mode ? -1 : mode })

  const table = () => {
    const s = page.snapshot
    if (!s) return
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement.dataset.mode : undefined
    body.replaceChildren(
      ...s.omega.map((omega, i) =>
        h(
          'tr',
          { class: i === page.mode ? 'chosen' : '', onclick: () => pick(i) },
          h(
            'th',
            { scope: 'row' },
            h(
              'button',
              {
                type: 'button',
                class: 'play',
                'data-mode': i,
                'aria-pressed': String(i === page.mode),
                'aria-label': `Animate mode ${i + 1}`,
                title: `Animate mode ${i + 1} (key ${i + 1})`,
              },
              `${i === page.mode ? '■' : '▶'} ${i + 1}`,
            ),
          ),
          h('td', {}, sig(omega)),
          h('td', {}, sig(s.frequency[i])),
          h('td', {}, sig(s.damped?.frequency[i])),
          h('td', {}, s.damped ? sig(100 * (s.damped.ratio[i] ?? Number.NaN), 3) : '–'),
          h('td', { class: 'words' }, s.modes[i].text),
        ),
      ),
    )
    if (focused) body.querySelector<HTMLElement>(`[data-mode="${focused}"]`)?.focus()
  }

  const play = () => {
    const s = page.snapshot
    const mode = page.mode
    if (!s || mode < 0) {
      animation.stop('mode')
      detail.replaceChildren(
        h(
          'p',
          { class: 'hint' },
          'Choose a mode to see it move, and which legs and directions it uses. Keys 1 to 6 do the same.',
        ),
      )
      amplitudeText.textContent = '–'
      return
    }
    const turned = s.geometry.platform.map((p) => s.geometry.matrix.map((r) => r[0] * p[0] + r[1] * p[1] + r[2] * p[2]))
    const size = Math.max(...s.geometry.platform.map((p) => Math.hypot(p[0], p[1], p[2])))
    const drawn = Number(amplitude.value) * 0.6 * size
    const scale = drawn / (reach(s.shape[mode], turned) || 1)
    amplitudeText.textContent = `${sig(1000 * drawn, 3)} mm`
    animation.play('mode', (t) => [twist(s.shape[mode], scale * Math.sin(2 * Math.PI * SWINGS * t)), noTwist()])
    const slower = (s.frequency[mode] ?? 0) / SWINGS
    detail.replaceChildren(
      h('p', {}, h('strong', {}, `Mode ${mode + 1}: `), s.modes[mode].text, '.'),
      h(
        'p',
        { class: 'hint' },
        `Drawn at ${SWINGS} swings a second, ${slower >= 1 ? `${sig(slower, 3)} times slower` : 'about as fast'} than the machine. The greatest joint displacement drawn is ${sig(1000 * drawn, 3)} mm.`,
      ),
      h(
        'div',
        { class: 'pair' },
        bars('Kinetic energy by direction', COORDINATES, s.modes[mode].share),
        bars(
          'Strain energy by leg',
          ['1', '2', '3', '4', '5', '6'].map((n) => `leg ${n}`),
          s.strain[mode],
        ),
      ),
    )
  }
  amplitude.addEventListener('input', play)
  store.on(['snapshot', 'mode'], () => {
    table()
    play()
  })

  const write = () => {
    const s = page.snapshot
    if (!s) return
    const head = [
      'mode',
      'omega_rad_s',
      'frequency_hz',
      'damped_frequency_hz',
      'damping_ratio',
      'description',
      ...COORDINATES.map((c) => `kinetic_${c}`),
      ...[1, 2, 3, 4, 5, 6].map((n) => `strain_leg_${n}`),
    ]
    saveCsv(
      'modes',
      head,
      s.omega.map((w, i) => [
        i + 1,
        w,
        s.frequency[i],
        s.damped?.frequency[i],
        s.damped?.ratio[i],
        s.modes[i].text,
        ...s.modes[i].share,
        ...s.strain[i],
      ]),
    )
  }
  return h(
    'div',
    {},
    h(
      'div',
      { class: 'bar' },
      h('h2', {}, 'Natural frequencies'),
      h('span', { class: 'spring' }),
      csvButton('Table of modes', write),
    ),
    h(
      'div',
      { class: 'scroll' },
      h(
        'table',
        { class: 'data', id: 'modes-table' },
        h(
          'caption',
          { class: 'hidden' },
          'Six natural frequencies at this pose. Undamped by Eq. 5 of the paper; damped with gravity and preload by the exact tangent.',
        ),
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            ...[
              ['Mode', ''],
              ['ω', 'rad/s'],
              ['f', 'Hz'],
              ['damped f', 'Hz'],
              ['damping', '%'],
              ['what moves', ''],
            ].map(([name, unit]) => h('th', { scope: 'col' }, name, unit ? h('small', {}, ` ${unit}`) : '')),
          ),
        ),
        body,
      ),
    ),
    h('div', { class: 'row amplitude' }, h('label', { for: 'amplitude' }, 'Amplitude drawn'), amplitude, amplitudeText),
    detail,
  )
}
