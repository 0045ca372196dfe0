// The page: header, pose and parameters, 3-D view, panels; and what asks the server when something changes.

import './style.css'
import { beginTheme, onTheme } from '../charts/theme'
import { Animation } from '../machine3d/animation'
import { Scene } from '../machine3d/scene'
import { type DesignPanel, designPanel } from '../panels/design'
import { legsPanel } from '../panels/legs'
import { modesPanel } from '../panels/modes'
import { open } from '../panels/opening'
import { type ParametersPanel, parametersPanel } from '../panels/parameters'
import { posePanel } from '../panels/pose'
import { responsePanel } from '../panels/response'
import { timePanel } from '../panels/simulation'
import { viewPanel } from '../panels/view'
import { workspacePanel } from '../panels/workspace'
import { fromAddress, toAddress } from '../state/address'
import type { Design, Snapshot, Start } from '../state/answers'
import { get, Live, type Refused } from '../state/api'
import { page, sourceKey, store } from '../state/store'
import { h, settled, status } from '../widgets/dom'
import { tabs } from '../widgets/tabs'
import { header, type Say } from './header'
import { listenToKeys } from './keys'
import { readout } from './readout'

const FIRST = 'motion-base'

/** A line that says something for a few seconds. */
function toast(): { element: HTMLElement; say: Say } {
  const element = status({ class: 'toast', hidden: true })
  const hide = settled(4000, () => {
    element.hidden = true
  })
  const say = (words: string) => {
    element.textContent = words
    element.hidden = false
    hide()
  }
  return { element, say }
}

/** Builds the page. Returns the panels that show errors at their fields. */
function build(start: Start): [ParametersPanel, DesignPanel] {
  const { element, say } = toast()
  const scene = new Scene()
  const animation = new Animation(scene)
  const parameters = parametersPanel()
  const design = designPanel(start.fields, () => store.set({ tab: 'design' }))
  const refused = h('p', { class: 'refused', role: 'alert', hidden: true })
  const panels = tabs([
    ['modes', 'Modes', modesPanel(animation)],
    ['legs', 'Legs', legsPanel()],
    ['workspace', 'Workspace', workspacePanel()],
    ['response', 'Response', responsePanel(animation)],
    ['time', 'Time', timePanel(animation)],
    ['design', 'Design', design.element],
  ])
  const side = h('div', { class: 'side' }, posePanel(), parameters.element)
  const middle = h('div', { class: 'middle' }, readout(), viewPanel(scene), refused)
  document.body.append(header(start, say), h('main', {}, side, middle, panels), element)
  listenToKeys(scene)
  store.on(['error'], () => {
    refused.textContent = page.error
    refused.hidden = !page.error
    scene.element.classList.toggle('stale', page.error !== '')
  })
  return [parameters, design]
}

/** Asks the server whenever the machine or its pose changes. */
function askTheServer(panels: [ParametersPanel, DesignPanel]): void {
  const failed = (error: Refused) => {
    store.set({ error: error.message })
    for (const { key, message } of error.errors) for (const panel of panels) panel.fail(key, message)
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
    (design) => store.set({ design, described: sourceKey(page.text, page.changes) }),
    failed,
  )
  const changed = settled(120, describe.request)
  store.on(['pose', 'joint', 'text', 'changes'], state.request)
  store.on(['changes'], () => page.described !== sourceKey(page.text, page.changes) && changed())
}

/** Keeps the address of the page up to date. */
function keepAddress(): void {
  const write = async () => history.replaceState(null, '', `#${await toAddress(page)}`)
  const address = settled(250, () => void write())
  store.on(['pose', 'joint', 'text', 'changes', 'mode', 'tab', 'colour', 'unit', 'box', 'preset'], address)
}

/** Show what an address says, or what the server was started with. */
async function restore({ presets, start }: Start, hash: string): Promise<void> {
  const { text: said, preset: name, ...rest } = await fromAddress(hash, presets)
  const first = start ?? { name: FIRST, text: presets[FIRST] }
  const text = said ?? first.text
  const preset = said === undefined ? (presets[first.name] === text ? first.name : '') : (name ?? '')
  if (await open(text, preset, rest)) return
  if (page.design) return
  await open(presets[FIRST], FIRST)
  await open(text, preset) // again, to show its errors beside that machine
}

async function begin(): Promise<void> {
  beginTheme()
  const start = await get<Start>('api/start')
  askTheServer(build(start))
  keepAddress()
  onTheme(() => page.snapshot && store.set({ snapshot: page.snapshot }))
  addEventListener('hashchange', () => void restore(start, location.hash))
  await restore(start, location.hash)
}

void begin()
