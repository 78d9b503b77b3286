// A local node of the RS-485 valve bus, to be judged; harness/iut/README.md describes the messages.
//
//   fieldproof run 'valve_bus/node/**' --iut 'exec:node examples/valve_node/node.mjs'
import { readSync, writeSync } from "node:fs";

const NEVER = 2n ** 63n - 1n;
const SECOND = 10n ** 12n; // times are picoseconds; a Number is exact up to 2.5 hours of them only, so BigInt
const [HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE, ON_TIME] = [1, 2, 3, 4, 5, 7];
const [CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, WRITE, READ, DRIVER] =
  [129, 130, 131, 132, 133, 135, 136, 137];
const VALVES = 0, LIMIT_SWITCHES = 1;

const least = (...times) => times.reduce((a, b) => (a < b ? a : b));

// Messages come in lock step: it is right to block.
function readAll(octets) {
  const buffer = Buffer.alloc(octets);
  for (let have = 0; have < octets; ) {
    const count = readSync(0, buffer, have, octets - have, null);
    if (count === 0) process.exit(0); // the bench has gone
    have += count;
  }
  return buffer;
}

const receive = () => readAll(readAll(4).readUInt32LE());

const u8 = (value) => Buffer.of(value);
const u16 = (value) => Buffer.of(value & 0xff, value >> 8);
const u64 = (value) => (buffer => (buffer.writeBigUInt64LE(BigInt(value)), buffer))(Buffer.alloc(8));
const text = (value) => Buffer.concat([u16(Buffer.byteLength(value)), Buffer.from(value)]);

function send(type, ...fields) {
  const body = Buffer.concat([u8(type), ...fields]);
  const head = Buffer.alloc(4);
  head.writeUInt32LE(body.length);
  let rest = Buffer.concat([head, body]);
  while (rest.length > 0) rest = rest.subarray(writeSync(1, rest));
}

class Node {
  constructor(settings) {
    const rate = settings.bit_rate || 62500n; // dip 2
    Object.assign(this, { settings, bit: SECOND / rate });
    this.half = ((settings.characters === 2n ? 10n : 11n) * SECOND) / (2n * rate); // a character
    const { address_tens: tens, address_units: units } = settings;
    this.address = tens > 9n || units > 9n ? 0 : Number(10n * tens + units);
    this.boards = settings.boards === 1n ? 0xff : 0xffff;
    this.power(false, 0n);
  }

  power(isOn, now) {
    Object.assign(this, { isOn, lastCommand: now, frame: [], isSpoilt: false });
    Object.assign(this, { busyUntil: 0n, answer: null, drivingUntil: 0n });
  }

  receive(start, busyUntil, data, flags, now) { // a character that is over
    if (!this.isOn) return;
    const gap = start - this.busyUntil;
    if (this.frame.length > 0 && gap >= 7n * this.half) this.endFrame(now);
    this.answer = null; // somebody else talks
    const isLate = this.frame.length > 0 && gap > 3n * this.half + 1000n;
    if (flags !== 0 || start < this.drivingUntil || isLate) this.isSpoilt = true;
    if (this.frame.length < 6) this.frame.push(data & 0xff); // six octets are as wrong as a hundred
    this.busyUntil = busyUntil;
  }

  silenceKnown() { // a character that began within the delimiter is over by then
    return this.frame.length > 0 ? this.busyUntil + 9n * this.half + this.bit : NEVER;
  }

  hostLost() {
    const limit = this.settings.loss_limit;
    return limit > 0n ? this.lastCommand + limit : NEVER;
  }

  nextTime() {
    const answer = this.answer ? this.answer.start - this.bit : NEVER;
    return this.isOn ? least(this.silenceKnown(), this.hostLost(), answer) : NEVER;
  }

  onTime(now) {
    if (now >= this.silenceKnown()) this.endFrame(now);
    if (this.answer && now >= this.answer.start - this.bit) this.transmit(now);
    if (now >= this.hostLost()) {
      this.lastCommand = now;
      send(WRITE, u16(VALVES), u64(0), u64(now));
    }
  }

  transmit(now) {
    const { start: wanted, octets } = this.answer;
    const start = wanted > now + this.bit ? wanted : now + this.bit;
    const ninth = this.settings.characters === 0n ? 0x100 : 0;
    const characters = octets.map((octet) => u16(ninth | octet));
    this.answer = null;
    this.drivingUntil = start + 6n * this.half + 2n * this.bit;
    send(DRIVER, u8(0), u8(1), u64(start - this.bit)); // all of it ahead
    send(CHARACTERS, u8(0), u64(start), u16(3), ...characters);
    send(DRIVER, u8(0), u8(0), u64(this.drivingUntil));
  }

  endFrame(now) {
    const { frame, isSpoilt } = this;
    Object.assign(this, { frame: [], isSpoilt: false });
    if (isSpoilt || frame.length !== 5 || frame.reduce((a, b) => a ^ b) !== 0) return;
    if (frame[0] !== this.address || this.address === 0) return;
    this.lastCommand = now;
    const [, command, data0, data1] = frame;
    if (command === 0) {
      send(WRITE, u16(VALVES), u64((data0 | (data1 << 8)) & this.boards), u64(now));
      if (this.settings.answers_writes !== 0n) this.answerWith(data0, data1);
    } else if (command === 1) {
      send(READ, u16(LIMIT_SWITCHES), u64(now));
      const switches = Number(receive().readBigUInt64LE(1)) & this.boards;
      this.answerWith(switches & 0xff, switches >> 8);
    }
  }

  answerWith(data0, data1) {
    const start = this.busyUntil + 7n * this.half + SECOND / 10000n;
    this.answer = { start, octets: [data0, data1, data0 ^ data1] };
  }
}

function nodeFor(message, at = 1) {
  const word = () => message.readBigInt64LE((at += 8) - 8);
  const short = () => message.readUInt16LE((at += 2) - 2);
  const name = () => ((length) => message.toString("utf8", at, (at += length)))(short());
  if (!name().startsWith("valve_bus/node/")) return null;
  word(); // the seed: nothing here is by chance
  return new Node(Object.fromEntries(Array.from({ length: short() }, () => [name(), word()])));
}

for (let node = null; ; ) {
  const message = receive();
  const type = message[0];
  if (type === HELLO) send(CAPABILITIES, u16(3), u8(1), text("valve node in Node.js"), u16(1), text("valve_bus"), text("node"));
  else if (type === ECHO) send(ECHOED, message.subarray(1));
  else {
    if (type === CASE_BEGIN) node = nodeFor(message);
    else if (type === POWER) node.power(message[1] !== 0, message.readBigInt64LE(2));
    else if (type === RECEIVE) {
      const now = message.readBigInt64LE(2);
      for (let at = 12; at < message.length; at += 19) {
        const [start, busyUntil] = [message.readBigInt64LE(at), message.readBigInt64LE(at + 8)];
        node.receive(start, busyUntil, message.readUInt16LE(at + 16), message[at + 18], now);
      }
    } else if (type === ON_TIME) node.onTime(message.readBigInt64LE(1));
    if (node) send(DONE, u64(node.nextTime()));
    else send(UNSUPPORTED);
  }
}
