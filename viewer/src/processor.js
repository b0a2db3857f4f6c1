// Whether the processor draws, not a graphics card: then every pixel and every shader costs.
let processor = true; // also where there is no WebGL at all

export const drawnByProcessor = () => processor;

/** Said once, by who opens WebGL. @param {boolean} is */
export function setDrawnByProcessor(is) { processor = is; }
