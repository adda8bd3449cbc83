// Where the data come from: a web socket, or the page itself when it was exported.

import { Track } from './decode.js';

/** Calls `hear` with every message of the server: an object, or { second, buffer, offset } of a scene, or { track, buffer }. */
export function open(hear, lost) {
  const data = document.getElementById('data');
  return data ? new Embedded(JSON.parse(data.textContent), hear) : new Socket(hear, lost);
}

class Socket {
  constructor(hear, lost) {
    this.socket = new WebSocket(new URL('socket', location.href).href.replace(/^http/, 'ws').replace(/#.*$/, ''));
    this.socket.binaryType = 'arraybuffer';
    this.socket.onclose = lost;
    this.socket.onmessage = ({ data }) => {
      if (typeof data === 'string') {
        hear(JSON.parse(data));
        return;
      }
      const [kind, about] = new Uint32Array(data, 0, 2);
      hear(kind === 1 ? { second: about, buffer: data, offset: 8 } : { track: about, buffer: data });
    };
  }

  askScene(second) {
    this.ask({ scene: second });
  }

  askTrack(track) {
    this.ask({ track: track.auv, from: track.end });
  }

  ask(what) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(what));
  }
}

class Embedded {
  constructor({ messages, seconds }, hear) {
    this.hear = hear;
    this.auvs = messages[0].cast.names.length;
    this.seconds = new Map(seconds.map((kept) => [kept.second, kept]));
    setTimeout(() => messages.forEach(hear));
  }

  askScene(second) {
    const kept = [...this.seconds.keys()].filter((key) => key <= second).pop();
    if (kept === undefined) return;
    const buffer = bytes(this.seconds.get(kept).scene);
    setTimeout(() => this.hear({ second, buffer, offset: 0 }));
  }

  askTrack(track) {
    for (const [second, { tracks }] of this.seconds) {
      if (second >= track.end) track.takeSecond(second, bytes(tracks), this.auvs);
    }
    setTimeout(() => this.hear({ track: track.auv }));
  }
}

function bytes(base64) {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0)).buffer;
}

export { Track };
