// What can be shown in the view, and what is shown at first.
export const layers = [
  { id: 'still', name: 'Static points', key: 's', on: true },
  { id: 'moving', name: 'Moving points', key: 'd', on: true },
  { id: 'unused', name: 'Points not used', key: 'u', on: true },
  { id: 'boxes', name: 'Object boxes', key: 'b', on: true },
  { id: 'arrows', name: 'Velocity (1 s displacement)', key: 'a', on: true },
  { id: 'ids', name: 'Object ids and speeds', key: 'i', on: true },
  { id: 'predicted', name: 'Predicted points', key: 'p', on: false },
  { id: 'path', name: 'Trajectory', key: 'j', on: true },
  { id: 'truth', name: 'Ground truth', key: 'g', on: true },
  { id: 'map', name: 'Static map', key: 'm', on: false },
  { id: 'traces', name: 'Moving points of the drive', key: 'q', on: false },
  { id: 'rings', name: 'Range rings', key: 'o', on: true },
  { id: 'sensor', name: 'Sensor and ego velocity', key: 'e', on: true },
];

export const usualLayers = () => new Set(layers.filter(({ on }) => on).map(({ id }) => id));

/** Those that a run has something for. */
export const layersOf = (report, run) => layers.filter(({ id }) =>
  id === 'map' || id === 'traces' ? Boolean(run[id])
    : id === 'truth' ? run.truth !== null
      : ['still', 'moving', 'unused', 'predicted'].includes(id) ? run.scans !== null
        : ['boxes', 'arrows', 'ids'].includes(id) ? run.frames.objects.some((list) => list.length > 0)
          : true);

/** A set with one entry put in or taken out. */
export function toggled(set, entry) {
  const changed = new Set(set);
  if (!changed.delete(entry)) changed.add(entry);
  return changed;
}
