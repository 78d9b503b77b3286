// The time line of a case: a lane per channel with its transmissions, faults and observations as marks, findings
// and burst windows across all lanes. It zooms by wheel, pinch, keys and buttons, pans by dragging, and says
// in words what is under the pointer or the focus.
import { drawn, element, replaceContent, visible } from "./dom.js";
import { niceStep, number, plural, unitOf } from "./format.js";
import { TimeLineModel } from "./time_line_model.js";

const kTop = 22;
const kLane = {withFrames: 56, withMarks: 34};
const kAxis = 24;
const kFrame = {top: 27, height: 20};
const kLetter = 6.3;
const kMostWords = 400;
const kAcrossLanes = new Set(["finding", "step"]);
const kPaper = 700;  // wide until it has a place; the drawing is scaled to its place

export function timeLine(packed) {
  const model = new TimeLineModel(packed);
  if (model.events.length === 0) return element("p", {class: "quiet"}, "The time line of this case has no event.");
  return new TimeLine(model).place;
}

class TimeLine {
  constructor(model) {
    this.model = model;
    this.chosen = null;
    this.pointers = new Map();
    this.lanes = lanesOf(model);
    this.height = this.lanes.at(-1).bottom + kAxis;
    this.drawing = drawn("svg", {"aria-hidden": "true", focusable: "false"});
    this.stage = element("div", {class: "stage", tabindex: "0", role: "application", "aria-roledescription": "time line",
      "aria-label": this.summary()}, this.drawing);
    this.words = element("p", {class: "readout", role: "status"});
    this.place = element("div", {class: "time-line"}, this.buttons(), this.stage, this.words, this.legend(), this.list());
    this.showFirstTrouble();
    this.listen();
    this.draw();
    new ResizeObserver(() => this.draw()).observe(this.stage);
  }

  summary() {
    const count = (kind) => this.model.events.filter((event) => event.kind === kind).length;
    const frames = count("frame") + count("changed");
    return `Time line: ${plural(frames, "transmission")}, ${number(count("changed"))} changed, ${plural(count("fault"), "fault")}, ` +
        `${plural(count("observation"), "observation")}, ${plural(count("finding"), "finding")}. ` +
        "Plus and minus zoom, left and right move, n and p go from event to event, 0 shows all.";
  }

  // What a reader looks for first.
  showFirstTrouble() {
    const trouble = this.model.first("finding") ?? this.model.first("fault");
    if (trouble) this.choose(trouble, false);
    else replaceContent(this.words, this.hint());
  }

  hint() {
    return `${plural(this.model.events.length, "event")}. Point at one, or press n; the wheel zooms once the time line has the focus.`;
  }

  buttons() {
    const button = (text, label, act) =>
      element("button", {type: "button", "aria-label": label, title: label, onclick: () => { act(); this.draw(); }}, text);
    const bar = element("div", {class: "buttons", role: "group", "aria-label": "Time line"},
        button("−", "Zoom out", () => this.model.zoom(2)), button("+", "Zoom in", () => this.model.zoom(0.5)),
        button("◀", "Earlier", () => this.model.pan(-0.5)), button("▶", "Later", () => this.model.pan(0.5)),
        button("All", "Show all", () => this.model.showAll()),
        button("‹ event", "Event before", () => this.stepTo(false)), button("event ›", "Next event", () => this.stepTo(true)));
    for (const kind of ["finding", "fault"]) {
      const first = this.model.first(kind);
      if (first) bar.append(button(`First ${kind}`, `Go to the first ${kind}`, () => this.goTo(first)));
    }
    return bar;
  }

  legend() {
    const kinds = [["frame", "transmission"], ["changed", "changed by a fault"], ["fault", "fault"],
      ["observation", "observation"], ["step", "step of the case"], ["finding", "finding"]];
    const keys = kinds.filter(([kind]) => this.model.first(kind))
        .map(([kind, text]) => element("li", {}, sample(kind), text));
    if (this.model.windows.length) keys.push(element("li", {}, sample("window"), "burst"));
    const cut = this.model.isCut ? element("li", {class: "cut"}, "The recording reached its bound: later events are left out.") : null;
    return element("ul", {class: "legend"}, keys, cut);
  }

  // The same in words, made when it is opened.
  list() {
    const shown = this.model.events.slice(0, kMostWords);
    const title = shown.length === this.model.events.length ? plural(shown.length, "event")
        : `the first ${number(shown.length)} of ${plural(this.model.events.length, "event")}`;
    const list = element("details", {class: "events screen-only"}, element("summary", {}, `In words: ${title}`));
    list.addEventListener("toggle", () => {
      if (list.children.length > 1) return;
      const lines = shown.map((event) => element("li", {class: event.kind}, event.text));
      list.append(element("ol", {class: "scroll", tabindex: "0", "aria-label": "Events in words"}, lines));
    }, {once: true});
    return list;
  }

  listen() {
    const stage = this.stage;
    stage.addEventListener("keydown", (event) => this.onKey(event));
    stage.addEventListener("wheel", (event) => this.onWheel(event), {passive: false});
    stage.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    stage.addEventListener("pointermove", (event) => this.onPointerMove(event));
    for (const end of ["pointerup", "pointercancel", "pointerleave"]) {
      stage.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    stage.addEventListener("dblclick", () => { this.model.showAll(); this.draw(); });
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const acts = {
      "+": () => this.model.zoom(0.5), "=": () => this.model.zoom(0.5), "-": () => this.model.zoom(2),
      ArrowLeft: () => this.model.pan(-0.2), ArrowRight: () => this.model.pan(0.2),
      ArrowUp: () => this.model.zoom(0.5), ArrowDown: () => this.model.zoom(2),
      PageUp: () => this.model.pan(-1), PageDown: () => this.model.pan(1),
      Home: () => this.model.show(this.model.all.from, this.model.all.from + this.model.span),
      End: () => this.model.show(this.model.all.to - this.model.span, this.model.all.to),
      0: () => this.model.showAll(), n: () => this.stepTo(true), p: () => this.stepTo(false),
    };
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
    this.draw();
  }

  // A page that scrolls under the pointer must go on scrolling: the wheel zooms what has the focus.
  onWheel(event) {
    const isSideways = Math.abs(event.deltaX) > Math.abs(event.deltaY) || event.shiftKey;
    const isAsked = event.ctrlKey || event.metaKey || document.activeElement === this.stage;
    if (!isSideways && !isAsked) return;
    event.preventDefault();
    if (isSideways) this.model.pan((event.deltaX || event.deltaY) / 800);
    else this.model.zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY / 300))), this.partAt(event.clientX));
    this.draw();
  }

  onPointerDown(event) {
    this.pointers.set(event.pointerId, event.clientX);
    const found = this.eventAt(event);
    if (found) this.choose(found, false);
    this.draw();
  }

  onPointerMove(event) {
    const before = this.pointers.get(event.pointerId);
    if (before === undefined) return this.hover(event);
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, x]) => x);
    if (others.length === 0) {
      this.model.pan((before - event.clientX) / this.width);
    } else {
      const [other] = others;
      const ratio = Math.abs(before - other) / Math.max(Math.abs(event.clientX - other), 1);
      this.model.zoom(Math.max(0.5, Math.min(2, ratio)), this.partAt((event.clientX + other) / 2));
    }
    this.pointers.set(event.pointerId, event.clientX);
    this.draw();
  }

  hover(pointer) {
    const found = this.eventAt(pointer);
    if (found && found !== this.chosen) {
      this.choose(found, false);
      this.draw();
    }
  }

  stepTo(forward) {
    const next = this.model.step(this.chosen, forward);
    if (next) this.choose(next, true);
  }

  goTo(event) {
    this.model.showAround(event);
    this.choose(event, false);
  }

  choose(event, isMoved) {
    this.chosen = event;
    replaceContent(this.words, event.text);
    if (isMoved && !this.isWide(event)) this.model.showAround(event);
  }

  isWide(event) {
    return this.model.inView(event) && (event.from === event.to || this.x(event.to) - this.x(event.from) > 3);
  }

  // ---- geometry ----

  get width() {
    return this.stage.clientWidth || kPaper;
  }

  x(us) {
    return ((us - this.model.view.from) / this.model.span) * this.width;
  }

  laneOf(event) {
    return this.lanes.find((lane) => lane.channel === event.channel) ?? this.lanes[0];
  }

  partAt(clientX) {
    const box = this.stage.getBoundingClientRect();
    return Math.min(1, Math.max(0, (clientX - box.left) / box.width));
  }

  // The event under the pointer: marks before frames, the nearest first.
  eventAt(pointer) {
    const box = this.stage.getBoundingClientRect();
    const x = pointer.clientX - box.left;
    const y = pointer.clientY - box.top;
    let best = null;
    let least = 7;
    for (const event of this.model.events) {
      if (!kAcrossLanes.has(event.kind) && !this.isInLane(event, y)) continue;
      const distance = Math.max(this.x(event.from) - x, x - this.x(event.to), 0) - event.order * 0.5;
      if (distance < least) [best, least] = [event, distance];
    }
    return best;
  }

  isInLane(event, y) {
    const lane = this.laneOf(event);
    return y >= lane.top && y < lane.bottom;
  }

  // ---- drawing ----

  draw() {
    this.drawing.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    this.drawing.replaceChildren(...this.drawnLanes(), ...this.drawnWindows(), ...this.drawnAxis(), ...this.drawnEvents());
  }

  drawnWindows() {
    const bottom = this.height - kAxis;
    return this.model.windows.filter((one) => one.to >= this.model.view.from && one.from <= this.model.view.to).map((one) => {
      const left = Math.max(this.x(one.from), 0);
      return drawn("rect", {class: "window", x: left, y: kTop - 8, height: bottom - kTop + 8,
        width: Math.max(Math.min(this.x(one.to), this.width) - left, 1)});
    });
  }

  drawnLanes() {
    return this.lanes.flatMap(({ name, top, middle }, at) => [
      at % 2 ? null : drawn("rect", {class: "lane-ground", x: 0, y: top, width: this.width, height: this.lanes[at].bottom - top}),
      drawn("line", {class: "lane", x1: 0, x2: this.width, y1: middle, y2: middle}),
      drawn("text", {class: "lane-name", x: 4, y: top + 12}, clipped(name, this.width - 8)),
    ].filter(Boolean));
  }

  drawnAxis() {
    const { from, to } = this.model.view;
    const step = niceStep(this.model.span, this.width / 75);
    const [unit, per] = unitOf(step);
    const bottom = this.height - kAxis;
    const ticks = [drawn("line", {class: "axis", x1: 0, x2: this.width, y1: bottom, y2: bottom})];
    for (let at = Math.ceil(from / step) * step; at <= to; at += step) {
      const x = this.x(at);
      ticks.push(drawn("line", {class: "grid", x1: x, x2: x, y1: kTop - 4, y2: bottom + 4}));
      const label = `${Number((at / per).toFixed(6))} ${unit}`;
      const anchor = x < 24 ? "start" : x > this.width - 30 ? "end" : "middle";
      ticks.push(drawn("text", {class: "tick", x: Math.min(Math.max(x, 2), this.width - 2), y: bottom + 17, "text-anchor": anchor}, label));
    }
    return ticks;
  }

  // Frames, and marks of a kind, that share a pixel are drawn once.
  drawnEvents() {
    const shapes = [];
    const ends = new Map();
    for (const event of this.model.events) {
      if (!this.model.inView(event)) continue;
      if (event.order > 0) continue;
      const right = this.x(event.to);
      const isPlain = event.kind === "frame" && event !== this.chosen;
      if (isPlain && right - (ends.get(event.channel) ?? -9) < 1) continue;
      ends.set(event.channel, right);
      shapes.push(...this.drawnFrame(event));
    }
    const marked = new Set();
    for (const event of this.model.events) {
      if (event.order === 0 || !this.model.inView(event)) continue;
      const pixel = `${event.kind} ${event.channel} ${Math.round(this.x(event.from))}`;
      if (marked.has(pixel) && event !== this.chosen) continue;
      marked.add(pixel);
      shapes.push(this.drawnMark(event));
    }
    return shapes;
  }

  drawnFrame(event) {
    const left = Math.max(this.x(event.from), -4);
    const width = Math.max(Math.min(this.x(event.to), this.width + 4) - left, 1.5);
    const top = this.laneOf(event).top + kFrame.top;
    const box = drawn("rect", {class: `${event.kind}${event === this.chosen ? " chosen" : ""}`, x: left, y: top, width,
      height: kFrame.height, rx: width > 6 ? 2 : 0});
    if (width < 26) return [box];
    return [box, drawn("text", {class: "frame-text", x: Math.max(left, 0) + 4, y: top + 14}, clipped(event.short, width - 8))];
  }

  drawnMark(event) {
    const x = this.x(event.from);
    const chosen = event === this.chosen ? " chosen" : "";
    if (event.kind === "finding") {
      return drawn("g", {class: `finding${chosen}`}, drawn("line", {x1: x, x2: x, y1: 10, y2: this.height - kAxis}),
          drawn("path", {d: `M${x - 6} 2h12v7l-6 6l-6 -6z`}));
    }
    if (event.kind === "step") {
      return drawn("g", {class: `step${chosen}`}, drawn("line", {x1: x, x2: x, y1: 10, y2: this.height - kAxis}),
          drawn("text", {x: x + 2, y: 10}, event.short));
    }
    const { top, middle, hasFrames } = this.laneOf(event);
    const below = hasFrames ? top + kFrame.top + kFrame.height + 1 : middle - 4;
    const shape = event.kind === "fault" ? `M${x - 5} ${top + 17}h10l-5 9z` : `M${x} ${below}l4.5 4l-4.5 4l-4.5 -4z`;
    return drawn("path", {class: `${event.kind}${chosen}`, d: shape});
  }
}

// A lane for each channel on which anything happens, one at least.
function lanesOf(model) {
  const seen = model.channels.map((name, channel) => ({name, channel, events: model.events.filter((one) => one.channel === channel)}))
      .filter(({ events }) => events.length > 0);
  let top = kTop;
  return (seen.length ? seen : [{name: "", channel: 0, events: []}]).map(({ name, channel, events }) => {
    const hasFrames = events.some((one) => one.order === 0);
    const bottom = top + (hasFrames ? kLane.withFrames : kLane.withMarks);
    const middle = hasFrames ? top + kFrame.top + kFrame.height / 2 : top + 23;
    const lane = {name, channel, hasFrames, top, middle, bottom};
    top = bottom;
    return lane;
  });
}

function clipped(text, width) {
  const shown = visible(text);
  const letters = Math.floor(width / kLetter);
  return shown.length <= letters ? shown : letters < 3 ? "" : `${shown.slice(0, letters - 1)}…`;
}

function sample(kind) {
  const marks = {fault: "M2 2h10l-5 9z", finding: "M2 1h10v6l-5 5l-5 -5z", observation: "M7 1l5 5l-5 5l-5 -5z", step: "M6 0h1v12h-1z"};
  const shape = marks[kind] ? drawn("path", {class: kind, d: marks[kind]})
      : drawn("rect", {class: kind, x: 0.5, y: 1.5, width: 13, height: 9});
  return drawn("svg", {width: 14, height: 12, "aria-hidden": "true", class: "sample"}, shape);
}
