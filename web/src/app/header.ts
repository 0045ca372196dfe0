// The header: designs to choose and to open, the link to this state, keys, light or dark.

import { toggleTheme } from '../charts/theme'
import { MOST_TEXT, open } from '../panels/opening'
import { toAddress } from '../state/address'
import type { Start } from '../state/answers'
import { page, store } from '../state/store'
import { button, type Choice, h, select } from '../widgets/dom'
import { spring } from '../widgets/layout'
import { showKeys } from './keys'
import type { Say } from './notices'

const OWN = 'own design'
const LATER = 'opens as soon as the server answers again.'
const OUTCOMES = { shown: 'is open.', refused: 'is not a design; see the Design panel.', waiting: LATER }
const OPEN_TITLE = 'Open a design file (TOML); dropping one on the page does the same'

function presetChoice({ presets }: Start, say: Say): Choice<string> {
  const options = [...Object.keys(presets).map((name) => [name, name] as const), ['', OWN] as const]
  const choice = select('Design', options, page.preset, async (name) => {
    const outcome = name ? await open(presets[name], name) : ''
    if (outcome === 'waiting') say(`${name} ${LATER}`)
    choice.set(page.preset) // the machine that is shown
  })
  choice.element.dataset.part = 'design'
  store.on(['design', 'text', 'preset'], () => {
    choice.set(page.preset)
    const own = choice.element.options[options.length - 1]
    own.textContent = page.preset ? OWN : (page.design?.name ?? OWN)
    document.title = `${page.design?.name ?? 'Flexapod'} · Flexapod`
  })
  return choice
}

/** The input of a design file; a file dropped on the page is taken too. */
function fileInput(say: Say): HTMLInputElement {
  const file = h('input', {
    type: 'file',
    accept: '.toml',
    class: 'hidden',
    id: 'design-file',
    'aria-label': 'Open a design file',
    tabindex: -1,
  })
  const take = async (chosen: File | undefined) => {
    if (!chosen) return
    const { name, size } = chosen
    if (size > MOST_TEXT) return say(`${name} has ${size} bytes; a design has at most ${MOST_TEXT}.`)
    const text = await chosen.text()
    const outcome = await open(text, '')
    const lossy = text.includes('\ufffd')
      ? ' It is not text in UTF-8: characters that could not be read are marked \ufffd.'
      : ''
    if (outcome !== 'superseded') say(`${name} ${OUTCOMES[outcome]}${lossy}`)
    file.value = ''
  }
  file.addEventListener('change', () => void take(file.files?.[0]))
  document.addEventListener('dragover', (event) => event.preventDefault())
  document.addEventListener('drop', (event) => {
    event.preventDefault()
    if (!(event.target as Element).closest('input[type=file]')) void take(event.dataTransfer?.files[0])
  })
  return file
}

async function share(say: Say): Promise<void> {
  history.replaceState(null, '', `#${await toAddress(page)}`)
  try {
    await navigator.clipboard.writeText(location.href)
    say('The link to this state is copied.')
  } catch {
    say('The address of this page is the link to this state.')
  }
}

export function header(start: Start, say: Say): HTMLElement {
  const file = fileInput(say)
  return h(
    'header',
    {},
    h('img', { src: './icon.svg', alt: '', width: 22, height: 22 }),
    h('h1', {}, 'Flexapod'),
    presetChoice(start, say).element,
    button('Open…', () => file.click(), { title: OPEN_TITLE }),
    file,
    spring(),
    button('Share', () => void share(say), { title: 'Copy a link to this state' }),
    button('Keys', showKeys, { class: 'wide-only' }),
    button('◐', toggleTheme, { class: 'icon', 'aria-label': 'Light or dark', title: 'Light or dark' }),
  )
}
