  const parts = all("[data-part]");
  const draw = f => {
    const s = Math.sin(2 * Math.PI * f / D.frames), t = f / D.frames * D.period;
    parts.forEach((p, i) => p.setAttribute("points", D.rest[i].map((v, j) => (v + s * D.move[i][j]).toFixed(1)).join(" ")));
    return t.toPrecision(2) + " s of " + D.period.toPrecision(3) + " s";
  };
