// A client of the Foxglove WebSocket protocol (github.com/foxglove/ws-protocol), as far as the page needs it: it connects
// to the server that the page came from, again and again, and hands over what comes.

const SUBPROTOCOL = 'foxglove.websocket.v1';
const MESSAGE = 1;
const RETRY = 2000; // ms

/**
 * @param {string} address ws://...
 * @param {object} use
 * @param {(phase: 'connecting'|'live'|'ended'|'lost', text: string) => void} use.phase
 * @param {(info: {name: string, sessionId: string}) => void} use.server a run that is watched from now on
 * @param {(text: string) => void} use.warning what the server says of this client
 * @param {(topic: string, stamp: bigint, message: DataView) => void} use.message stamp in ns
 * @param {() => string[]} use.topics that are wanted
 */
export function connect(address, use, createSocket = (...words) => new WebSocket(...words)) {
  let socket = null;
  let channels = new Map(); // topics by number
  let subscriptions = new Map(); // numbers of channels by topic; the same number is the one of the subscription
  let hasEnded = false;

  const say = (text) => { if (socket?.readyState === 1) socket.send(JSON.stringify(text)); };

  /** Asks for what is wanted and not yet asked for, and the other way round. */
  function subscribe() {
    const wanted = use.topics();
    const begun = [...channels].filter(([, topic]) => wanted.includes(topic) && !subscriptions.has(topic));
    const ended = [...subscriptions].filter(([topic]) => !wanted.includes(topic));
    for (const [id, topic] of begun) subscriptions.set(topic, id);
    for (const [topic] of ended) subscriptions.delete(topic);
    if (begun.length) say({ op: 'subscribe', subscriptions: begun.map(([id]) => ({ id, channelId: id })) });
    if (ended.length) say({ op: 'unsubscribe', subscriptionIds: ended.map(([, id]) => id) });
  }

  function hear(text) {
    const said = JSON.parse(text);
    if (said.op === 'serverInfo') {
      use.server(said);
      use.phase('live', '');
    } else if (said.op === 'advertise') {
      for (const { id, topic } of said.channels) channels.set(id, topic);
      subscribe();
    } else if (said.op === 'status' && said.id === 'end') {
      hasEnded = true;
      use.phase('ended', said.message);
    } else if (said.op === 'status') {
      use.warning(said.message);
    }
  }

  function take(buffer) {
    const view = new DataView(buffer);
    const topic = view.byteLength >= 13 && view.getUint8(0) === MESSAGE ? channels.get(view.getUint32(1, true)) : undefined;
    if (topic) use.message(topic, view.getBigUint64(5, true), new DataView(buffer, 13));
  }

  function open() {
    channels = new Map();
    subscriptions = new Map();
    socket = createSocket(address, [SUBPROTOCOL]);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => { hasEnded = false; };
    socket.onmessage = ({ data }) => {
      try {
        if (typeof data === 'string') hear(data);
        else take(data);
      } catch (error) {
        use.warning(`a message cannot be read: ${error.message}`);
      }
    };
    socket.onclose = () => {
      if (!hasEnded) use.phase('lost', '');
      setTimeout(open, RETRY);
    };
  }

  use.phase('connecting', '');
  open();
  return { subscribe };
}
