// Texts into the clipboard, also where the page may not use it directly.

/** @param {HTMLElement} told the button that says for a moment that it worked */
export async function copyText(text, told) {
  let done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = document.createElement('textarea');
    field.value = text;
    document.body.append(field);
    field.select();
    done = document.execCommand('copy');
    field.remove();
  }
  const before = told.textContent;
  told.textContent = done ? 'Copied' : 'Not copied';
  told.disabled = true;
  setTimeout(() => {
    told.textContent = before;
    told.disabled = false;
  }, 1200);
}
