// The view as a PNG: scene, what lies flat over it, labels, and a line that says what it shows.

const STRIP = 30; // px under the picture

/**
 * @param {{canvases: HTMLCanvasElement[], labels: HTMLElement[], width: number, height: number}} view in CSS pixels; the
 *   first canvas must have been drawn in this very task
 * @param {{text: string, bar: {gradient: string[], ends: string[]}|null}} legend
 * @param {{ground: string, ink: string}} colours
 * @returns {Promise<Blob>}
 */
export function pictureOf({ canvases, labels, width, height }, legend, { ground, ink }) {
  const ratio = canvases[0].width / width;
  const sheet = document.createElement('canvas');
  sheet.width = Math.round(width * ratio);
  sheet.height = Math.round((height + STRIP) * ratio);
  const pen = sheet.getContext('2d');
  pen.scale(ratio, ratio);
  pen.fillStyle = ground;
  pen.fillRect(0, 0, width, height + STRIP);
  const frame = canvases[0].getBoundingClientRect();
  for (const canvas of canvases) {
    if (canvas.hidden) continue;
    const box = canvas.getBoundingClientRect();
    pen.drawImage(canvas, box.left - frame.left, box.top - frame.top, box.width, box.height);
  }
  pen.textBaseline = 'middle';
  pen.font = '600 11px system-ui, "DejaVu Sans", sans-serif';
  for (const label of labels) {
    const box = label.getBoundingClientRect();
    pen.lineWidth = 4;
    pen.strokeStyle = ground;
    pen.fillStyle = getComputedStyle(label).color;
    pen.strokeText(label.textContent, box.left - frame.left + 4, (box.top + box.bottom) / 2 - frame.top);
    pen.fillText(label.textContent, box.left - frame.left + 4, (box.top + box.bottom) / 2 - frame.top);
  }
  let left = 8;
  const middle = height + STRIP / 2;
  pen.fillStyle = ink;
  pen.font = '11px system-ui, "DejaVu Sans", sans-serif';
  const write = (text) => {
    pen.fillText(text, left, middle);
    left += pen.measureText(text).width + 8;
  };
  if (legend.bar) {
    write(legend.bar.ends[0]);
    const fill = pen.createLinearGradient(left, 0, left + 120, 0);
    legend.bar.gradient.forEach((colour, k) => fill.addColorStop(k / (legend.bar.gradient.length - 1), colour));
    pen.fillStyle = fill;
    pen.fillRect(left, middle - 5, 120, 10);
    left += 128;
    pen.fillStyle = ink;
    write(legend.bar.ends[1]);
  }
  write(legend.text);
  return new Promise((done) => { sheet.toBlob(done, 'image/png'); });
}

/** Lets the reader save it. */
export function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
