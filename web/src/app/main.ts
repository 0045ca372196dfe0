// The page: header, pose and machine numbers, 3-D view, panels; and what asks the server when something changes.

import './style.css'
import { get, Live, Refused } from '../state/api'
import { Animation } from '../machine3d/animation'
import { beginTheme, onTheme, toggleTheme } from '../charts/colours'
import { designPanel, MOST_TEXT, open } from '../panels/design'
import { button, h, select, settled, status } from '../widgets/dom'
import { sig } from '../widgets/format'
import { legsPanel } from '../panels/legs'
import { modesPanel } from '../panels/modes'
import { numbersPanel } from '../panels/parameters'
import { posePanel, setPose } from '../panels/pose'
import { responsePanel } from '../panels/response'
import { Scene } from '../machine3d/scene'
import { fromAddress, page, sourceKey, store, toAddress } from '../state/store'
import { timePanel } from '../panels/simulation'
import { tabs } from '../widgets/tabs'
import type { Design, FieldError, Snapshot, Start } from '../state/answers'
import { viewPanel } from '../panels/view'
import { workspacePanel } from '../panels/workspace'

const FIRST = 'motion-base'

function header(start: Start, say: (words: string) => void): HTMLElement {
  const presets = select(
    'Design',
    [...Object.keys(start.presets).map((name) => [name, name] as const), ['', 'own design'] as const],
    page.preset,
    (name) => {
      if (name) void open(start.presets[name], name)
      else presets.set(page.preset)
    },
  )
  const file = h('input', {
    type: 'file',
    accept: '.toml',
    class: 'hidden',
    id: 'design-file',
    'aria-label': 'Open a design file',
    tabindex: -1,
  })
  file.addEventListener('change', () => void take(file.files?.[0]))
  const take = async (chosen: File | undefined) => {
    if (!chosen) return
    if (chosen.size > MOST_TEXT)
      return say(`${chosen.name} has ${chosen.size} bytes; a design has at most ${MOST_TEXT}.`)
    say(
      (await open(await chosen.text(), ''))
        ? `${chosen.name} is open`
        : `${chosen.name} is not a design; see the Design panel.`,
    )
    file.value = ''
  }
  document.addEventListener('dragover', (event) => event.preventDefault())
  document.addEventListener('drop', (event) => {
    event.preventDefault()
    if (!(event.target as Element).closest('input[type=file]')) void take(event.dataTransfer?.files[0])
  })
  store.on(['design', 'text', 'preset'], () => {
    presets.set(page.preset)
    presets.element.options[presets.element.options.length - 1].textContent = page.preset
      ? 'own design'
      : (page.design?.name ?? 'own design')
    document.title = `${page.design?.name ?? 'Flexapod'} · Flexapod`
  })
  const share = async () => {
    history.replaceState(null, '', `#${await toAddress()}`)
    try {
      await navigator.clipboard.writeText(location.href)
      say('The link to this state is copied.')
    } catch {
      say('The address of this page is the link to this state.')
    }
  }
  const dark = button('◐', toggleTheme, { class: 'icon', 'aria-label': 'Light or dark', title: 'Light or dark' })
  return h(
    'header',
    {},
    h('img', { src: './icon.svg', alt: '', width: 22, height: 22 }),
    h('h1', {}, 'Flexapod'),
    presets.element,
    button('Open…', () => file.click(), { title: 'Open a design file (TOML); dropping one on the page does the same' }),
    file,
    h('span', { class: 'spring' }),
    button('Share', () => void share(), { title: 'Copy a link to this state' }),
    button('Keys', () => help().showModal(), { class: 'wide-only' }),
    dark,
  )
}

const KEYS: [string, string][] = [
  ['1 … 6', 'animate a mode, again to stop'],
  ['0', 'stop the animation'],
  ['H', 'home pose'],
  ['I F S T', 'isometric, front, side, top view'],
  ['arrows, + −', 'turn and zoom the 3-D view when it has the focus; step through plots'],
  ['Tab', 'next control; arrows move a slider'],
]

function help(): HTMLDialogElement {
  const old = document.querySelector('dialog')
  if (old) return old
  const dialog = h(
    'dialog',
    { 'aria-label': 'Keys' },
    h('h2', {}, 'Keys'),
    h('dl', {}, ...KEYS.flatMap(([key, words]) => [h('dt', {}, key), h('dd', {}, words)])),
    h(
      'p',
      { class: 'hint' },
      'Drawn with three.js and uPlot; ',
      h('a', { href: './licenses.txt' }, 'their licences'),
      '.',
    ),
    button('Close', () => dialog.close()),
  )
  document.body.append(dialog)
  return dialog
}

function shortcuts(scene: Scene): void {
  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName)) return
    const key = event.key.toLowerCase()
    if (key >= '1' && key <= '6') store.set({ mode: page.mode === Number(key) - 1 ? -1 : Number(key) - 1 })
    else if (key === '0') store.set({ mode: -1 })
    else if (key === 'h' && page.design) setPose(page.design.home)
    else if (key === 'i') scene.look('iso')
    else if (key === 'f') scene.look('front')
    else if (key === 's') scene.look('side')
    else if (key === 't') scene.look('top')
    else if (key === '?') help().showModal()
  })
}

/** The chief results, always in view, and spoken when they settle. */
function readout(): HTMLElement {
  const cell = (name: string, id: string, unit: string) => {
    const value = h('output', { id })
    return {
      value,
      element: h('div', { class: 'figure' }, h('span', { class: 'name' }, name, unit && `, ${unit}`), value),
    }
  }
  const index = cell('Index ω₁', 'index', 'rad/s')
  const frequency = cell('f₁', 'frequency', 'Hz')
  const condition = cell('cond(H)', 'condition', '')
  const force = cell('Max force', 'force', 'N')
  const limits = cell('Limits', 'limits', '')
  const spoken = status({ class: 'hidden' })
  const speak = settled(900, () => {
    if (page.snapshot)
      spoken.textContent = `Index ${sig(page.snapshot.index, 4)} radians per second, condition number ${sig(page.snapshot.condition, 3)}. ${page.snapshot.limits.exceeded.join('. ')}`
  })
  store.on(['snapshot'], () => {
    const s = page.snapshot
    if (!s) return
    index.value.textContent = sig(s.index)
    frequency.value.textContent = sig(s.frequency[0])
    condition.value.textContent = sig(s.condition, 4)
    force.value.textContent = s.legs.force ? sig(Math.max(...s.legs.force.map((f) => Math.abs(f ?? 0))), 4) : '–'
    limits.value.textContent = !s.limits.any
      ? 'none set'
      : s.limits.ok
        ? 'within'
        : `${s.limits.exceeded.length} exceeded`
    limits.element.classList.toggle('exceeded', !s.limits.ok)
    speak()
  })
  return h(
    'div',
    { class: 'readout', role: 'group', 'aria-label': 'Chief results' },
    ...[index, frequency, condition, force, limits].map((c) => c.element),
    spoken,
  )
}

async function begin(): Promise<void> {
  beginTheme()
  const start = await get<Start>('api/start')
  const toast = status({ class: 'toast', hidden: true })
  const hide = settled(4000, () => (toast.hidden = true))
  const say = (words: string) => {
    toast.textContent = words
    toast.hidden = false
    hide()
  }
  const scene = new Scene()
  const animation = new Animation(scene)
  const numbers = numbersPanel()
  const design = designPanel(start.fields, () => store.set({ tab: 'design' }))
  const refused = h('p', { class: 'refused', role: 'alert', hidden: true })
  document.body.append(
    header(start, say),
    h(
      'main',
      {},
      h('div', { class: 'side' }, posePanel(), numbers.element),
      h('div', { class: 'middle' }, readout(), viewPanel(scene), refused),
      tabs([
        ['modes', 'Modes', modesPanel(animation)],
        ['legs', 'Legs', legsPanel()],
        ['workspace', 'Workspace', workspacePanel()],
        ['response', 'Response', responsePanel(animation)],
        ['time', 'Time', timePanel(animation)],
        ['design', 'Design', design.element],
      ]),
    ),
    toast,
  )
  shortcuts(scene)
  store.on(['error'], () => {
    refused.textContent = page.error
    refused.hidden = !page.error
    scene.element.classList.toggle('stale', page.error !== '')
  })
  const failed = (error: Refused) => {
    store.set({ error: error.message })
    for (const f of error.fields as FieldError[]) {
      numbers.fail(f.key, f.message)
      design.fail(f.key, f.message)
    }
  }
  const state = new Live<Snapshot>(
    'api/state',
    () => store.question(),
    (snapshot) => store.set({ snapshot, error: '' }),
    failed,
  )
  const describe = new Live<Design>(
    'api/design',
    () => ({ design: page.text, changes: page.changes }),
    (d) => store.set({ design: d, described: sourceKey(page.text, page.changes) }),
    failed,
  )
  const address = settled(250, () => void toAddress().then((a) => history.replaceState(null, '', `#${a}`)))
  const changed = settled(120, describe.request)
  store.on(['pose', 'joint', 'text', 'changes'], state.request)
  store.on(['changes'], () => page.described !== sourceKey(page.text, page.changes) && changed())
  store.on(['pose', 'joint', 'text', 'changes', 'mode', 'tab', 'colour', 'unit', 'box', 'preset'], address)
  onTheme(() => page.snapshot && store.set({ snapshot: page.snapshot }))
  addEventListener('hashchange', () => void restore(start, location.hash))
  await restore(start, location.hash)
}

/** Show what an address says, or what the server was started with. */
async function restore(start: Start, hash: string): Promise<void> {
  const said = await fromAddress(hash, start.presets)
  const preset =
    said.text !== undefined
      ? (said.preset ?? '')
      : start.start && start.presets[start.start.name] === start.start.text
        ? start.start.name
        : start.start
          ? ''
          : FIRST
  const text = said.text ?? start.start?.text ?? start.presets[FIRST]
  const { text: _text, preset: _preset, ...rest } = said
  if (await open(text, preset, rest)) return
  if (page.design) return
  await open(start.presets[FIRST], FIRST)
  await open(text, preset) // once more for its errors, now beside a machine
}

void begin()
