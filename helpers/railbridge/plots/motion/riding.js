  // A corner stands where it rests, less what numbers H of the frame (px up) move it by, each with a
  // weight. Lines have a row of such numbers of their own; groups also move along the track.
  const parts = all("[data-part]"), lines = all("[data-line]"), groups = all("[data-along]"), dots = all("[data-dot]");
  const draw = f => {
    const k = Math.min(Math.floor(f), D.loop ? D.frames - 1 : D.frames - 2), next = (k + 1) % D.frames, part = f - k;
    const mix = values => values[k] + (values[next] - values[k]) * part;
    const place = (line, x, y) => line.setAttribute("points", x.map((v, j) => v + "," + y(j).toFixed(1)).join(" "));
    const now = D.H.map(mix);
    parts.forEach((p, i) => {
      const {x, y, by} = D.parts[i];
      place(p, x, j => y[j] - by.reduce((sum, [h, weights]) => sum + weights[j] * now[h], 0));
    });
    lines.forEach((line, i) => {
      const {x, y, rows} = D.lines[i], [a, b] = [D[rows][k], D[rows][next]];
      place(line, x, j => y[j] - a[j] - (b[j] - a[j]) * part);
    });
    groups.forEach(g => g.setAttribute("transform", "translate(" + (D.along[0] + D.along[1] * f).toFixed(1) + " 0)"));
    const t = D.time[0] + D.time[1] * f, values = D.said.map(({mm}) => mix(mm));
    dots.forEach((dot, i) => {
      dot.setAttribute("cx", (D.axes[0] + D.axes[1] * f).toFixed(1));
      dot.setAttribute("cy", (D.axes[2] - D.axes[3] * values[i]).toFixed(1));
    });
    return "t = " + t.toFixed(2) + " s: " + D.said.map(({name}, i) => name + " " + values[i].toFixed(1) + " mm").join(", ");
  };
