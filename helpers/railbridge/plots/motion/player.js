(() => {
const D = __DATA__;
for (const root of document.querySelectorAll('[data-animation="__KEY__"]')) {
  if (root.dataset.ready) continue;
  root.dataset.ready = "yes";
  const still = root.querySelector("img"), all = s => [...svg.querySelectorAll(s)];
  const parsed = new DOMParser().parseFromString(atob(still.src.split(",")[1]), "image/svg+xml");
  const svg = document.importNode(parsed.documentElement, true);
  still.replaceWith(svg);
  svg.setAttribute("aria-label", still.alt);
__DRAW__
  const bar = document.createElement("div"), button = document.createElement("button");
  const slider = document.createElement("input"), says = document.createElement("span");
  // JupyterLab then leaves arrow keys to the slider; it asks the focused element itself.
  for (const control of [button, slider]) control.dataset.lmSuppressShortcuts = "true";
  bar.style.cssText = "display:flex;flex-wrap:wrap;gap:10px;align-items:center;padding:4px 10px";
  button.type = "button";
  button.style.cssText = "min-width:5.5em;font:inherit;padding:3px 8px;color:#222;background:#eee;border:1px solid #777;"
    + "border-radius:4px;cursor:pointer";
  Object.assign(slider, {type: "range", min: 0, max: D.frames - 1, step: 1});
  slider.style.cssText = "flex:1;min-width:120px;accent-color:#0072B2";
  slider.setAttribute("aria-label", D.slider);
  says.style.cssText = "min-width:15em;font-variant-numeric:tabular-nums";
  const calm = matchMedia("(prefers-reduced-motion: reduce)"), last = D.loop ? D.frames : D.frames - 1;
  let at = D.start, before = null;
  const show = () => {
    const words = draw(at);
    says.textContent = words;
    slider.value = Math.round(at);
    slider.setAttribute("aria-valuetext", words);
    const name = before !== null ? "Pause" : calm.matches ? "Step" : "Play";
    if (button.textContent !== name) {
      button.textContent = name;
      button.setAttribute("aria-label", name + " animation");
    }
  };
  const tick = now => {
    if (before === null || !svg.isConnected) return;
    at += Math.max(0, now - before) / 1000 * last / D.seconds;  // a frame may have begun before the click
    before = now;
    if (at >= last) { if (D.loop) at %= last; else { at = last; before = null; } }
    show();
    if (before !== null) requestAnimationFrame(tick);
  };
  button.onclick = () => {
    if (before !== null) before = null;
    else if (calm.matches) at = at >= D.frames - 1 ? 0 : Math.min(D.frames - 1, Math.round(at + D.frames / 24));
    else {
      if (!D.loop && at >= last) at = 0;
      before = performance.now();
      requestAnimationFrame(tick);
    }
    show();
  };
  slider.oninput = () => { before = null; at = +slider.value; show(); };
  bar.append(button, slider, says);
  svg.after(bar);
  root.querySelector("[data-still]").remove();
  show();
}
})();
