// The events of one case, with times in microseconds from the first of them, and the view on them.
import { exactTime, time } from "./format.js";

const kNarrowestUs = 0.05;

// What packed_timeline wrote, as timeline.json has it.
function unpacked(packed) {
  const begin = BigInt(packed.begin_ps);
  const at = (since) => String(begin + BigInt(since));
  const text = (place) => packed.texts[place];
  return {
    is_cut: packed.is_cut,
    channels: packed.channels,
    transmissions: packed.transmissions.map(([channel, start, length, words, levels, isChanged]) => ({channel, start_ps: at(start),
      end_ps: at(BigInt(start) + BigInt(length)), text: text(words), levels, is_changed: isChanged === 1})),
    faults: packed.faults.map(([channel, time, words]) => ({channel, time_ps: at(time), text: text(words)})),
    observations: packed.observations.map(([channel, time, what, value]) =>
        ({channel, time_ps: at(time), what: text(what), value: text(value)})),
    findings: packed.findings.map(([time, requirement, expected, actual]) =>
        ({time_ps: at(time), requirement: text(requirement), expected: text(expected), actual: text(actual)})),
    windows: packed.windows.map(([kind, from, to]) => ({kind: text(kind), from_ps: at(from), to_ps: at(to)})),
    steps: packed.steps.map(([time, words]) => ({time_ps: at(time), text: text(words)})),
  };
}

export class TimeLineModel {
  constructor(packed) {
    const stored = unpacked(packed);
    const times = allTimes(stored);
    this.isCut = stored.is_cut;
    this.channels = stored.channels;
    this.start = times.reduce((a, b) => (b < a ? b : a), times[0] ?? 0n);
    const last = times.reduce((a, b) => (b > a ? b : a), this.start);
    this.events = this.eventsOf(stored).sort((a, b) => a.from - b.from || a.order - b.order);
    this.windows = stored.windows.map((one) => ({from: this.at(one.from_ps), to: this.at(one.to_ps), kind: one.kind}));
    const span = Math.max(this.us(last - this.start), kNarrowestUs);
    this.all = {from: -span * 0.01, to: span * 1.01};
    this.view = {...this.all};
  }

  us(picoseconds) {
    return Number(picoseconds) / 1e6;
  }

  at(picoseconds) {
    return this.us(BigInt(picoseconds) - this.start);
  }

  eventsOf(stored) {
    const name = (channel) => this.channels[channel] ?? "";
    const point = (kind, order, one, text) => ({kind, order, channel: one.channel ?? -1, from: this.at(one.time_ps),
      to: this.at(one.time_ps), short: "", text: `${exactTime(one.time_ps)}  ${text}`});
    return [
      ...stored.transmissions.map((one) => ({kind: one.is_changed ? "changed" : "frame", order: 0, channel: one.channel,
        from: this.at(one.start_ps), to: this.at(one.end_ps), short: one.text,
        text: `${exactTime(one.start_ps)}  ${name(one.channel)}: ${one.text} (${one.levels} levels, ` +
            `${time(this.at(one.end_ps) - this.at(one.start_ps))}${one.is_changed ? ", changed by a fault" : ""})`})),
      ...stored.faults.map((one) => point("fault", 1, one, `fault on ${name(one.channel) || "the line"}: ${one.text}`)),
      ...stored.observations.map((one) =>
          point("observation", 2, one, `${name(one.channel) || "application"}: ${one.what} ${one.value}`)),
      ...stored.steps.map((one) => ({...point("step", 1, one, `step ${one.text}`), short: one.text.match(/^[\d.]*/)[0]})),
      ...stored.findings.map((one) =>
          point("finding", 3, one, `finding: ${one.actual}; expected: ${one.expected} (${one.requirement})`)),
    ];
  }

  inView(event) {
    return event.to >= this.view.from && event.from <= this.view.to;
  }

  get span() {
    return this.view.to - this.view.from;
  }

  show(from, to) {
    const span = Math.min(Math.max(to - from, kNarrowestUs), this.all.to - this.all.from);
    const begin = Math.min(Math.max(from, this.all.from), this.all.to - span);
    this.view = {from: begin, to: begin + span};
  }

  // Makes the view `factor` times as wide; what is at `anchor` (0 left, 1 right) stays there.
  zoom(factor, anchor = 0.5) {
    const middle = this.view.from + this.span * anchor;
    const span = Math.max(this.span * factor, kNarrowestUs);
    this.show(middle - span * anchor, middle + span * (1 - anchor));
  }

  pan(part) {
    this.show(this.view.from + this.span * part, this.view.to + this.span * part);
  }

  showAll() {
    this.view = {...this.all};
  }

  // About four frames to each side of an event.
  showAround(event) {
    const frame = this.events.find((one) => one.order === 0 && one.to > one.from);
    const reach = 8 * Math.max(event.to - event.from, frame ? frame.to - frame.from : 10);
    this.show(event.from - reach, event.to + reach);
  }

  first(kind) {
    return this.events.find((event) => event.kind === kind);
  }

  // The event after (or before) this one; the first in view when there is none.
  step(event, forward) {
    if (!event) return this.events.find((one) => this.inView(one)) ?? this.events[0];
    return this.events[this.events.indexOf(event) + (forward ? 1 : -1)] ?? event;
  }
}

function allTimes(stored) {
  return [
    ...stored.transmissions.flatMap((one) => [one.start_ps, one.end_ps]),
    ...[...stored.faults, ...stored.observations, ...stored.findings, ...stored.steps].map((one) => one.time_ps),
  ].map((text) => BigInt(text));
}
