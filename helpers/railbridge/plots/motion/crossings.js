  const deck = all("[data-deck]"), train = all("[data-train]")[0], wheels = all("[data-wheel]"), bars = all("[data-bar]");
  const dot = all("[data-dot]")[0], n = D.deck[0].length;
  const draw = f => {
    const k = Math.min(Math.floor(f), D.frames - 2), part = f - k, mix = (a, b) => a + (b - a) * part;
    const y = D.deck[k].map((v, j) => mix(v, D.deck[k + 1][j]));
    const points = y.map((v, j) => (D.left + D.span * j / (n - 1)).toFixed(1) + "," + (D.rail + v).toFixed(1)).join(" ");
    deck.forEach(d => d.setAttribute("points", points));
    const head = mix(D.head[k], D.head[k + 1]);
    train.setAttribute("transform", "translate(" + head.toFixed(1) + " 0)");
    wheels.forEach((wheel, a) => {
      const x = head - D.delay[a], u = (x - D.left) / D.span * (n - 1), on = u >= 0 && u <= n - 1;
      const j = Math.min(Math.floor(u), n - 2), low = D.rail + (on ? y[j] + (y[j + 1] - y[j]) * (u - j) : 0);
      wheel.setAttribute("cx", x.toFixed(1));
      wheel.setAttribute("cy", (low - 3.5).toFixed(1));
      const [first, forces] = D.force[a], i = k - first, there = on && i >= 0 && i + 1 < forces.length;
      const length = there ? mix(forces[i], forces[i + 1]) : 0;
      for (const [key, v] of [["x1", x], ["x2", x], ["y1", low + 9], ["y2", low + 9 + length]])
        bars[a].setAttribute(key, v.toFixed(1));
      bars[a].setAttribute("stroke-opacity", there ? 1 : 0);
    });
    dot.setAttribute("cx", mix(D.dot[k][0], D.dot[k + 1][0]).toFixed(1));
    dot.setAttribute("cy", mix(D.dot[k][1], D.dot[k + 1][1]).toFixed(1));
    return "t = " + mix(D.time[k], D.time[k + 1]).toFixed(2) + " s, " + mix(D.value[k], D.value[k + 1]).toFixed(2) + " mm";
  };
