// Light or dark, as what the view lies in: every notebook has ways of its own to say so, but all have text on paper.

/** Whether the text around an element is light. */
function lightText(element: Element): boolean {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 1
  const context = canvas.getContext('2d', { willReadFrequently: true })!
  context.fillStyle = getComputedStyle(element).color // whatever its notation
  context.fillRect(0, 0, 1, 1)
  const [red, green, blue] = context.getImageData(0, 0, 1, 1).data
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 127
}

/** Give `host` the theme of `around`, once it is on the page and when that changes; each time `changed` is called. */
export function followSurroundings(around: Element, host: HTMLElement, changed: () => void): () => void {
  const look = () => {
    if (!host.isConnected) return
    const theme = lightText(around) ? 'dark' : 'light'
    if (host.dataset.theme === theme) return
    host.dataset.theme = theme
    changed()
  }
  const placed = new ResizeObserver(look)
  placed.observe(host)
  const attributes = new MutationObserver(() => {
    look()
    setTimeout(look, 500) // style sheets may come after the attribute that asks for them
  })
  for (const part of [document.documentElement, document.body]) attributes.observe(part, { attributes: true })
  const preferred = matchMedia('(prefers-color-scheme: dark)')
  preferred.addEventListener('change', look)
  return () => {
    placed.disconnect()
    attributes.disconnect()
    preferred.removeEventListener('change', look)
  }
}
