// Numbers, times and shares as a reader of a report wants them.

const kPerUnit = [["s", 1e6], ["ms", 1e3], ["us", 1], ["ns", 1e-3], ["ps", 1e-6]];

// Each is dear to make.
const kFormats = new Map();

function written(value, options) {
  const key = JSON.stringify(options);
  if (!kFormats.has(key)) kFormats.set(key, new Intl.NumberFormat("en", options));
  return kFormats.get(key).format(value).replaceAll(",", "\u202f");
}

// Thousands apart, and no more than six digits of a fraction.
export function number(value, digits = 6) {
  if (typeof value !== "number" || !Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e15)) return value.toExponential(3);
  return written(value, {maximumSignificantDigits: Math.max(digits, Math.ceil(Math.log10(size + 1)))});
}

export function fixed(value, digits) {
  return Number.isFinite(value) ? value.toFixed(digits) : String(value);
}

// Numbers of one column, with as many decimals as the finest of them needs, three at most; what is smaller than
// that is written with a power of ten.
export function alike(values) {
  const all = values.filter((value) => typeof value === "number" && Number.isFinite(value));
  const kMost = 3;
  const isFine = (digits) => all.every((value) => Math.abs(value - Number(value.toFixed(digits))) < 10 ** -kMost / 2);
  const digits = [0, 1, 2].find(isFine) ?? kMost;
  return (value) => {
    if (typeof value !== "number" || !Number.isFinite(value)) return String(value);
    if (value !== 0 && Math.abs(value) < 10 ** -kMost / 2) return value.toExponential(1);
    return written(value, {minimumFractionDigits: digits, maximumFractionDigits: digits});
  };
}

export function scientific(value) {
  return value === 0 ? "0" : value.toExponential(2);
}

// "3 of 107"
export function part(count, whole) {
  return `${number(count)} of ${number(whole)}`;
}

export function plural(count, one, many = `${one}s`) {
  return `${number(count)} ${count === 1 ? one : many}`;
}

// Microseconds in the unit that fits `size`, which is their own size unless given.
export function time(us, size = Math.abs(us), digits = 4) {
  const [unit, per] = unitOf(size);
  return `${Number((us / per).toPrecision(Math.max(digits, Math.ceil(Math.log10(Math.abs(us / per) + 1)))))} ${unit}`;
}

export function unitOf(us) {
  return kPerUnit.find(([, per]) => us >= per) ?? (us === 0 ? kPerUnit[2] : kPerUnit[4]);
}

// A decimal string of picoseconds, exact.
export function exactTime(picoseconds) {
  const text = BigInt(picoseconds);
  const sign = text < 0n ? "-" : "";
  const size = text < 0n ? -text : text;
  const rest = String(size % 1000000n).padStart(6, "0").replace(/0+$/, "");
  const whole = String(size / 1000000n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
  return `${sign}${whole}${rest ? `.${rest}` : ""} us`;
}

// Times in a text of the program, which writes them to the picosecond: to the nanosecond, but three decimals at least.
export function roundedTimes(text) {
  const kDecimals = {s: 9, ms: 6, us: 3, ns: 3};
  return text.replace(/(\d+\.\d{4,}) (s|ms|us|ns)\b/g, (all, digits, unit) => {
    const exact = Number(digits).toFixed(kDecimals[unit]);
    return `${exact.replace(/(\.\d{3}\d*?)0+$/, "$1")} ${unit}`;
  });
}

// Nanoseconds are as much as a reader wants; `exactTime` is there on demand.
export function shownTime(picoseconds) {
  const us = Number(BigInt(picoseconds) / 1000n) / 1000;
  return `${written(us, {minimumFractionDigits: 3, maximumFractionDigits: 3})} us`;
}

export function duration(us) {
  return us >= 1e6 ? `${number(us / 1e6, 3)} s` : us >= 1e3 ? `${number(us / 1e3, 3)} ms` : `${number(us, 3)} us`;
}

// Steps of 1, 2 or 5 times a power of ten, about `count` of them over `span`.
export function niceStep(span, count) {
  const rough = span / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10);
}
