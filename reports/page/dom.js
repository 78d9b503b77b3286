// Makes elements. Text of an implementation comes into the page here and nowhere else, as text.

const kInvisible = /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff]/g;

// What would steer the text around it, or not be seen, is written out.
export function visible(text) {
  return String(text).replace(kInvisible, (one) => `\\u{${one.codePointAt(0).toString(16).toUpperCase()}}`);
}

// element("td", {class: "number", onclick: f}, "text", otherElement): attributes that are false or null are
// left out, true is an empty one; children may be arrays, and null.
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  setAttributes(made, attributes);
  append(made, children);
  return made;
}

export function drawn(name, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  setAttributes(made, attributes);
  append(made, children);
  return made;
}

function setAttributes(made, attributes) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) {
      made.addEventListener(key.slice(2), value);
    } else {
      made.setAttribute(key, value === true ? "" : visible(value));
    }
  }
}

export function append(made, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    made.append(child instanceof Node ? child : visible(child));
  }
}

export function replaceContent(made, ...children) {
  made.replaceChildren();
  append(made, children);
}

// A long word that may break behind '/' and '_'.
export function breakable(text) {
  return visible(text).split(/(?<=[/_])/).flatMap((piece, at) => (at === 0 ? [piece] : [element("wbr"), piece]));
}

// Name and value pairs; a pair whose value is empty is left out.
export function definitions(pairs) {
  const list = element("dl", {class: "facts"});
  for (const [name, value] of pairs) {
    if (value === "" || value === null || value === undefined) continue;
    const isLong = typeof value === "string" && value.length > 160;
    list.append(element("div", {class: isLong ? "long" : null}, element("dt", {}, name), element("dd", {}, value)));
  }
  return list;
}

// A command with a button that copies it.
export function command(text) {
  const button = element("button", {type: "button", class: "copy", "aria-label": `Copy: ${text}`}, "Copy");
  const shown = element("code", {}, text);
  button.addEventListener("click", async () => {
    button.textContent = (await copied(text, shown)) ? "Copied" : "Selected";
    setTimeout(() => (button.textContent = "Copy"), 1500);
  });
  return element("div", {class: "command"}, shown, button);
}

// Without a clipboard the text is selected, for the keyboard to copy.
async function copied(text, shown) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    getSelection().selectAllChildren(shown);
    return false;
  }
}

export function section(id, title, ...children) {
  const heading = element("h2", {id: `${id}-heading`}, title);
  return element("section", {id, "aria-labelledby": `${id}-heading`}, heading, children);
}

export function notice(...children) {
  return element("div", {class: "notice"}, children);
}

// What few readers want: on paper it is left out, unless it was opened.
export function folded(title, ...children) {
  return element("details", {class: "folded"}, element("summary", {}, title), children);
}

// A thing as wide as it wants in a box that scrolls by itself.
export function scrollBox(label, ...children) {
  return element("div", {class: "scroll", role: "region", "aria-label": label, tabindex: "0"}, children);
}
