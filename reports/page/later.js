// Parts that are made when the page has time: what a reader sees first is there first. All of them are there
// before printing, and soon after loading for whoever searches the page; then the body says data-is-whole.
import { element } from "./dom.js";

const waiting = [];

// A place that `make` fills with one element.
export function later(make) {
  const place = element("div", {class: "later"});
  waiting.push(() => place.replaceWith(make()));
  return place;
}

export function makeWhole() {
  while (waiting.length) waiting.shift()();
  document.body.dataset.isWhole = "";
}

export function makeLater() {
  addEventListener("beforeprint", makeWhole);
  matchMedia("print").addEventListener("change", makeWhole);
  const next = () => {
    waiting.shift()?.();
    if (waiting.length === 0) return makeWhole();
    whenIdle(next);
  };
  whenIdle(next);
}

function whenIdle(act) {
  if ("requestIdleCallback" in globalThis) requestIdleCallback(act, {timeout: 500});
  else setTimeout(act, 20);
}
