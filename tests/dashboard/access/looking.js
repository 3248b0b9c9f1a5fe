// What people without a pointer or without eyes would miss on a page.

// Name of what has the focus.
const focused = () => {
    const e = document.activeElement, label = e.labels && e.labels[0];
    return (e.ariaLabel || (label && label.innerText) || e.innerText || e.value || e.tagName).trim();
};

// Whether the focus is seen: its outline, or the element without one.
const bareFocus = () => {
  const e = document.activeElement, { outlineStyle, outlineWidth } = getComputedStyle(e);
  return outlineStyle !== "none" && parseFloat(outlineWidth) >= 2 ? [] : [e.outerHTML.slice(0, 200)];
};

// Controls and pictures without names, ids used twice, references to nothing.
const nameless = () => {
    const seen = (e) => e.offsetParent || e.getClientRects().length;
    const all = (what) => [...document.querySelectorAll(what)].filter(seen);
    const name = (e) => (e.ariaLabel || document.getElementById(e.getAttribute("aria-labelledby"))?.innerText
        || e.labels?.[0]?.innerText || e.innerText || e.title || "").trim();
    const ids = [...document.querySelectorAll("[id]")].map((e) => e.id);
    const wrong = [];
    const note = (what, found) => found.forEach((e) => wrong.push(`${what}: ${e.outerHTML.slice(0, 160)}`));
    note("no name", all("button, a, input, select, canvas, [role=img], [role=group], [role=tablist], [role=tabpanel]")
        .filter((e) => e.type !== "hidden" && !e.closest("[aria-hidden=true]") && !e.closest("[role=img] *")
            && !(e.tagName === "CANVAS" && e.closest("[role=img]")) && !name(e)));
    note("not a role for a picture", all("canvas").filter((e) => !e.closest("[role=img], [role=application], [aria-hidden=true]")));
    note("refers to nothing", ["aria-describedby", "aria-labelledby", "aria-controls"].flatMap((a) =>
        all(`[${a}]`).filter((e) => !document.getElementById(e.getAttribute(a)))));
    note("a control inside a control", all("button button, button input, [role=button] input, a button"));
    ids.filter((id, k) => ids.indexOf(id) !== k).forEach((id) => wrong.push(`twice: ${id}`));
    return wrong;
};

// Texts whose contrast is below the 4.5 of WCAG 2.2, criterion 1.4.3.
const faint = () => {
    const rgba = (text) => text.match(/[\d.]+/g).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
        .map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
        .reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0);
    const over = (top, below) => { const a = top[3] === undefined ? 1 : top[3]; return [0, 1, 2].map((k) => a * top[k] + (1 - a) * below[k]); };
    const behind = (e) => e ? over(rgba(getComputedStyle(e).backgroundColor), behind(e.parentElement)) : [255, 255, 255];
    const found = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
        const text = walker.currentNode.nodeValue.trim(), e = walker.currentNode.parentElement;
        if (!text || !e.getClientRects().length || e.closest(".mm-hidden, [disabled], .mm-skip, script, style, option, [aria-hidden=true]")) continue;
        let alpha = 1;
        for (let p = e; p; p = p.parentElement) alpha *= Number(getComputedStyle(p).opacity);
        const back = behind(e), ink = rgba(getComputedStyle(e).color);
        const front = over([...ink.slice(0, 3), (ink[3] === undefined ? 1 : ink[3]) * alpha], back);
        const [a, b] = [light(front), light(back)].sort((x, y) => y - x), ratio = (a + 0.05) / (b + 0.05);
        if (ratio < 4.5) found.push(`${ratio.toFixed(2)}: ${text.slice(0, 60)}`);
    }
    return found;
};

// Levels of the headings that are shown, from the page's head on.
const levels = () => [...document.querySelectorAll("h1, h2, h3, h4, h5, h6")]
  .filter((e) => e.getClientRects().length).map((e) => Number(e.tagName[1]));
