// The six legs: lengths, static forces, joint angles, and the limits they exceed.

import { h } from '../widgets/dom'
import { csvButton, saveCsv } from '../widgets/download'
import { sig } from '../widgets/format'
import { page, store } from '../state/store'

export function legsPanel(): HTMLElement {
  const body = h('tbody')
  const note = h('p', { class: 'hint' })
  store.on(['snapshot', 'unit'], () => {
    const s = page.snapshot
    if (!s) return
    const factor = page.unit === 'mm' ? 1000 : 1
    body.replaceChildren(
      ...s.legs.length.map((length, i) => {
        const wrong = s.limits.by_leg[i]
        const limit = !s.limits.any ? 'none set' : wrong.length ? wrong.join('; ') : 'within'
        return h(
          'tr',
          { class: wrong.length ? 'exceeded' : '' },
          h('th', { scope: 'row' }, String(i + 1)),
          h('td', {}, sig(length === null ? null : length * factor)),
          h('td', {}, sig(s.legs.force?.[i], 4)),
          h('td', {}, sig(s.legs.energy?.[i], 3)),
          h('td', {}, sig(s.legs.universal[i], 3)),
          h('td', {}, sig(s.legs.spherical[i], 3)),
          h('td', { class: 'words' }, wrong.length ? h('strong', {}, `▲ ${limit}`) : limit),
        )
      }),
    )
    head.textContent = ` ${page.unit}`
    note.textContent = `${s.legs.why || 'Forces that hold the pose at rest under gravity; positive is compression.'} Least distance between leg axes: ${sig((s.leg_distance ?? Number.NaN) * factor, 4)} ${page.unit}. Largest sensible sampling time of a controller: ${sig(1000 * (s.sampling_time ?? Number.NaN), 3)} ms.`
  })
  const head = h('small', {}, ' mm')
  const write = () => {
    const s = page.snapshot
    if (!s) return
    saveCsv(
      'legs',
      [
        'leg',
        'length_m',
        'static_force_n',
        'static_energy_j',
        'universal_angle_deg',
        'spherical_angle_deg',
        'exceeded',
      ],
      s.legs.length.map((length, i) => [
        i + 1,
        length,
        s.legs.force?.[i],
        s.legs.energy?.[i],
        s.legs.universal[i],
        s.legs.spherical[i],
        s.limits.by_leg[i].join('; '),
      ]),
    )
  }
  return h(
    'div',
    {},
    h(
      'div',
      { class: 'bar' },
      h('h2', {}, 'Legs at rest'),
      h('span', { class: 'spring' }),
      csvButton('Table of legs', write),
    ),
    h(
      'div',
      { class: 'scroll' },
      h(
        'table',
        { class: 'data', id: 'legs-table' },
        h('caption', { class: 'hidden' }, 'Length, static force and energy, joint angles and limits of each leg'),
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            h('th', { scope: 'col' }, 'Leg'),
            h('th', { scope: 'col' }, 'length', head),
            ...[
              ['force', 'N'],
              ['energy', 'J'],
              ['base joint', '°'],
              ['platform joint', '°'],
              ['limits', ''],
            ].map(([name, unit]) => h('th', { scope: 'col' }, name, unit ? h('small', {}, ` ${unit}`) : '')),
          ),
        ),
        body,
      ),
    ),
    note,
  )
}
