(root => {
  // What the widgets leave without a name for screen readers: handles, numbers, the player's buttons.
  const icons = {"fa-play": "Play", "fa-pause": "Pause", "fa-stop": "Stop", "fa-retweet": "Repeat"};
  const call = (element, name) => {
    if (element.getAttribute("aria-label") !== name) element.setAttribute("aria-label", name);
  };
  const nameAll = () => {
    for (const control of root.querySelectorAll(".rb-control")) {
      const label = control.querySelector(".widget-inline-hbox > .widget-label")?.textContent;
      if (!label) continue;
      control.querySelectorAll("[role=slider]").forEach(handle => call(handle, label));
      control.querySelectorAll(".rb-number input").forEach(number => call(number, label + ", typed"));
      for (const [icon, name] of Object.entries(icons))
        control.querySelectorAll(".widget-play button:has(." + icon + ")").forEach(button => call(button, name + ": " + label));
    }
    const picture = root.querySelector(".rb-picture");
    const image = picture?.matches("img") ? picture : picture?.querySelector("img");
    root.querySelectorAll("textarea").forEach(code => call(code, "The code"));
    if (image) image.alt = "The picture; the words below it say what it shows";
  };
  nameAll();
  new MutationObserver(nameAll).observe(root, {childList: true, subtree: true});
  for (const player of root.querySelectorAll(".widget-play"))
    new MutationObserver(nameAll).observe(player, {attributes: true, attributeFilter: ["class"], subtree: true});
})(this.closest(".rb-panel"))
