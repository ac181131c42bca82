"use strict";
// The building in three dimensions. Lengths in m: x east, y north, z up. The tables say the same without it.
(() => {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const $ = (id) => document.getElementById(id);
  const canvas = $("canvas"), labels = $("labels");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  } catch {
    $("no-gl").hidden = false;
    return;
  }
  $("viewer").hidden = false;
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const vector = (p) => new THREE.Vector3(p[0], p[1], p[2]);
  const element = (tag, text, className) => {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  };

  // --- the scene ---------------------------------------------------------------------------------------------
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(32, 1, 0.05, 5000);
  camera.up.set(0, 0, 1);
  const ambient = new THREE.AmbientLight(0xffffff, 1.9);
  const light = new THREE.DirectionalLight(0xffffff, 1.6);
  scene.add(ambient, light, light.target);
  renderer.shadowMap.type = THREE.PCFShadowMap;

  function doubleArea(points) {
    const sum = new THREE.Vector3(), a = new THREE.Vector3(), b = new THREE.Vector3();
    for (let i = 1; i + 1 < points.length; i++) {
      a.subVectors(points[i], points[0]);
      b.subVectors(points[i + 1], points[0]);
      sum.add(a.cross(b));
    }
    return sum;
  }
  const normalOf = (points) => doubleArea(points).normalize();
  const areaOf = (points) => 0.5 * doubleArea(points).length();

  function faces(points, holes, normal) {
    const along = new THREE.Vector3().subVectors(points[1], points[0]).normalize();
    const up = new THREE.Vector3().crossVectors(normal, along);
    const flat = (p) => new THREE.Vector2(p.dot(along), p.dot(up));
    // Triangulation wants holes the other way round.
    const inner = holes.map((hole) => (normalOf(hole).dot(normal) > 0 ? hole.slice().reverse() : hole));
    const triangles = THREE.ShapeUtils.triangulateShape(points.map(flat), inner.map((hole) => hole.map(flat)));
    const every = points.concat(...inner);
    const place = new Float32Array(9 * triangles.length), direction = new Float32Array(9 * triangles.length);
    triangles.forEach((triangle, i) => triangle.forEach((corner, k) => {
      every[corner].toArray(place, 9 * i + 3 * k);
      normal.toArray(direction, 9 * i + 3 * k);
    }));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(place, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(direction, 3));
    return geometry;
  }

  function outline(points, material, closed = true) {
    const shown = closed ? points.concat([points[0]]) : points;
    return new THREE.Line(new THREE.BufferGeometry().setFromPoints(shown), material);
  }

  // Of two parts that overlap in one plane, such as a door in its wall, the smaller one is in front: the number
  // of parts, one before the other, that a part is behind.
  function levels() {
    const planes = new Map();
    data.parts.forEach(({ corners }, number) => {
      const points = corners.map(vector), normal = normalOf(points), about = new THREE.Box3().setFromPoints(points);
      if ((Math.abs(normal.x) > 1e-6 ? normal.x : Math.abs(normal.y) > 1e-6 ? normal.y : normal.z) < 0) normal.negate();
      const key = [normal.x, normal.y, normal.z, normal.dot(points[0])].map((x) => Math.round(100 * x)).join(" ");
      // Neighbours that share an edge do not overlap.
      const inside = about.clone().expandByVector(about.getSize(new THREE.Vector3()).multiplyScalar(-0.01));
      planes.set(key, [...(planes.get(key) || []), { number, inside, area: areaOf(points) }]);
    });
    const found = data.parts.map(() => 0);
    for (const plane of planes.values()) {
      plane.sort((a, b) => a.area - b.area);
      plane.forEach((one, k) => {
        for (const other of plane.slice(0, k)) {
          if (other.inside.intersectsBox(one.inside)) found[one.number] = Math.max(found[one.number], found[other.number] + 1);
        }
      });
    }
    return found;
  }

  const building = new THREE.Group();
  const edges = new THREE.LineBasicMaterial();
  const marked = new THREE.LineBasicMaterial();
  const normals = new THREE.Group();
  const arrows = new THREE.LineBasicMaterial();
  const box = { low: new THREE.Vector3(1, 1, 1).multiplyScalar(Infinity), high: new THREE.Vector3(1, 1, 1).multiplyScalar(-Infinity) };
  const behind = levels();
  const parts = data.parts.map((part, number) => {
    const points = part.corners.map(vector);
    const normal = normalOf(points);
    for (const p of points) { box.low.min(p); box.high.max(p); }
    const material = new THREE.MeshLambertMaterial({
      side: THREE.DoubleSide, transparent: true, opacity: part.kind === "window" ? 0.45 : 1,
      depthWrite: part.kind !== "window", polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 + 16 * behind[number],
    });
    const mesh = new THREE.Mesh(faces(points, part.holes.map((hole) => hole.map(vector)), normal), material);
    const edge = outline(points, part.marked ? marked : edges);
    mesh.userData = part;
    mesh.castShadow = part.kind !== "window";
    mesh.receiveShadow = true;
    building.add(mesh, edge);
    const middle = points.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(points.length);
    return { part, mesh, edge, points, normal, middle };
  });
  scene.add(building, normals);
  const centre = new THREE.Vector3().addVectors(box.low, box.high).multiplyScalar(0.5);
  const size = Math.max(0.5 * box.low.distanceTo(box.high), 0.5);
  const ground = box.low.z;
  if (data.parts.length <= 1500) for (const { part, middle, normal } of parts) {
    if (part.kind === "shade") continue;
    const end = middle.clone().addScaledVector(normal, 0.16 * size);
    normals.add(outline([middle, end], arrows, false));
    const side = new THREE.Vector3().crossVectors(normal, Math.abs(normal.z) > 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 0, 1)).normalize();
    for (const sign of [1, -1]) {
      const barb = end.clone().addScaledVector(normal, -0.04 * size).addScaledVector(side, sign * 0.02 * size);
      normals.add(outline([end, barb], arrows, false));
    }
  }
  normals.visible = false;

  // --- colors ------------------------------------------------------------------------------------------------
  const fixed = {
    outdoors: data.palette[0], "another zone": data.palette[2], ground: data.palette[7], adiabatic: data.palette[3],
    measured: data.palette[1], scheduled: data.palette[4], "internal mass": data.palette[6], shade: "#8a8f96",
  };
  const hidden = new Set();
  let scheme = "construction";
  const us = data.parts.map((part) => part.u).filter((u) => u !== null);
  const uLow = Math.min(...us), uHigh = Math.max(...us);
  // Square root: most walls are well insulated, and windows are far away from them.
  const uPart = (u) => (uHigh > uLow ? Math.sqrt((u - uLow) / (uHigh - uLow)) : 0.5);
  const scaleEnds = ["#f6e6a2", "#b43c0f"];
  const uColor = (u) => new THREE.Color(scaleEnds[0]).lerp(new THREE.Color(scaleEnds[1]), uPart(u));
  const classOf = (part) => (scheme === "u" ? (part.u === null ? "no U value" : "with a U value") : part[scheme]);

  function classes() {
    const names = [...new Set(data.parts.map(classOf))];
    const found = new Map();
    let number = 0;
    for (const name of names) {
      const base = name === "shade" || name === "no zone" || name === "no U value" ? fixed.shade
        : scheme === "boundary" && fixed[name] ? fixed[name] : data.palette[number++ % data.palette.length];
      // After the last color the first one comes again, lighter.
      const round = Math.floor((number - 1) / data.palette.length);
      found.set(name, new THREE.Color(base).lerp(new THREE.Color("#ffffff"), Math.max(0, Math.min(0.75, 0.3 * round))));
    }
    return found;
  }

  function paint() {
    const colors = classes(), keys = $("keys");
    keys.replaceChildren();
    if (scheme === "u" && us.length) {
      const item = element("li");
      const bar = element("div", undefined, "scale");
      const stops = [0, 0.25, 0.5, 0.75, 1].map((f) => "#" + uColor(uLow + f * f * (uHigh - uLow)).getHexString());
      bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
      const ends = element("div", undefined, "ends");
      for (const u of [uLow, uLow + 0.25 * (uHigh - uLow), uHigh]) ends.append(element("span", u.toPrecision(3)));
      item.append(bar, ends, element("span", "W/(m² K)", "muted"));
      keys.append(item);
    }
    for (const [name, color] of colors) {
      const item = element("li"), label = element("label"), input = element("input"), swatch = element("span", undefined, "swatch");
      input.type = "checkbox";
      input.checked = !hidden.has(`${scheme} ${name}`);
      input.addEventListener("change", () => {
        hidden[input.checked ? "delete" : "add"](`${scheme} ${name}`);
        show();
      });
      swatch.style.setProperty("--swatch", "#" + color.getHexString());
      const count = data.parts.filter((part) => classOf(part) === name).length;
      label.append(input, ...(scheme === "u" ? [] : [swatch]), element("span", `${name} (${count})`));
      item.append(label);
      keys.append(item);
    }
    if (data.parts.some((part) => part.marked)) keys.append(element("li", "Red edges: with a warning", "red-edges"));
    for (const { part, mesh } of parts) {
      mesh.material.color.copy(scheme === "u" && part.u !== null ? uColor(part.u) : colors.get(classOf(part)));
    }
    show();
  }

  function show() {
    const inside = $("show-inside").checked;
    for (const { part, mesh, edge } of parts) {
      mesh.visible = edge.visible = !hidden.has(`${scheme} ${classOf(part)}`);
      const side = inside && part.kind !== "shade" ? THREE.BackSide : THREE.DoubleSide;
      if (mesh.material.side !== side) { mesh.material.side = side; mesh.material.needsUpdate = true; }
    }
    normals.visible = $("show-normals").checked;
    render();
  }

  // --- sun ---------------------------------------------------------------------------------------------------
  const sun = data.sun;
  const bytes = atob(sun.data);
  const raw = new Int16Array(bytes.length / 2);
  for (let i = 0; i < raw.length; i++) {
    const level = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
    raw[i] = level > 32767 ? level - 65536 : level;
  }
  const sunAt = (day, k) => new THREE.Vector3().fromArray(raw, 3 * (day * sun.times + k)).divideScalar(sun.levels);
  function direction(day, hour) {
    const place = hour / 24 * (sun.times - 1);
    const k = Math.min(Math.floor(place), sun.times - 2);
    return sunAt(day, k).lerp(sunAt(day, k + 1), place - k).normalize();
  }
  const sky = new THREE.Group(), reach = 1.35 * size, inSky = [];
  const base = new THREE.Vector3(centre.x, centre.y, ground);
  const pathLine = new THREE.LineBasicMaterial({ color: 0xd9902f }), faint = new THREE.LineBasicMaterial();
  const disc = new THREE.Mesh(new THREE.SphereGeometry(0.055 * size, 20, 14), new THREE.MeshBasicMaterial({ color: 0xe8a317 }));
  const ray = outline([base, base], pathLine, false);
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(5 * size, 5 * size), new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.35 }));
  floor.position.set(centre.x, centre.y, ground - 0.02 * size);
  floor.receiveShadow = true;
  floor.visible = false;
  const arc = (day, material) => {
    const points = [];
    for (let hour = 0; hour <= 24; hour += 0.25) {
      const to = direction(day, hour);
      if (to.z >= 0) points.push(base.clone().addScaledVector(to, reach));
    }
    if (material === faint) inSky.push(...points);
    return points.length > 1 ? outline(points, material, false) : null;
  };
  const circle = [];
  for (let k = 0; k <= 72; k++) circle.push(new THREE.Vector3(reach * Math.sin(k * Math.PI / 36), reach * Math.cos(k * Math.PI / 36), 0).add(base));
  sky.add(outline(circle, faint, false), disc, ray, ...[171, 79, 354].map((day) => arc(day, faint)).filter(Boolean));
  scene.add(sky, floor);
  let today = null;
  const months = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
  const compass = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
  function shine() {
    const day = +$("day").value - 1, hour = +$("hour").value;
    const to = direction(day, hour), up = to.z > 0;
    const date = new Date(Date.UTC(sun.year, 0, 1 + day));
    $("day-text").textContent = `${date.getUTCDate()} ${months[date.getUTCMonth()]}`;
    const minutes = Math.round(60 * (hour % 1));
    $("hour-text").textContent = `${Math.floor(hour)}:${String(minutes).padStart(2, "0")}`;
    const height = Math.asin(to.z) * 180 / Math.PI;
    const azimuth = (Math.atan2(to.x, to.y) * 180 / Math.PI + 360) % 360;
    const zone = `UTC${sun.offset < 0 ? "−" : "+"}${Math.abs(sun.offset)}`;
    $("sun-text").textContent = (up
      ? `Sun ${height.toFixed(1)}° above the horizon, azimuth ${azimuth.toFixed(1)}° (${compass[Math.round(azimuth / 45) % 8]}).`
      : "The sun is below the horizon.") + ` Standard time of the site (${zone}), without daylight saving.`;
    disc.visible = ray.visible = up;
    disc.position.copy(base).addScaledVector(to, reach);
    ray.geometry.setFromPoints([base, disc.position]);
    if (today) { sky.remove(today); today.geometry.dispose(); }
    today = arc(day, pathLine);
    if (today) { today.renderOrder = 1; sky.add(today); }
    const shadows = $("show-shadows").checked;
    sky.visible = $("show-sun").checked;
    if (floor.visible !== shadows || renderer.shadowMap.enabled !== shadows) {
      renderer.shadowMap.enabled = light.castShadow = floor.visible = shadows;
      for (const { mesh } of parts) mesh.material.needsUpdate = true;
      floor.material.needsUpdate = true;
    }
    const from = up || shadows ? to : new THREE.Vector3(0.3, -0.6, 0.75);
    light.intensity = up ? 1.6 : shadows ? 0 : 1.0;
    light.position.copy(centre).addScaledVector(from, 3 * size);
    light.target.position.copy(centre);
    const range = light.shadow.camera;
    range.left = range.bottom = -1.6 * size;
    range.right = range.top = 1.6 * size;
    range.near = 0.1 * size;
    range.far = 8 * size;
    range.updateProjectionMatrix();
    light.shadow.mapSize.set(2048, 2048);
    light.shadow.bias = -0.0005;
    light.shadow.normalBias = 0.01 * size;
    render();
  }

  // --- names over the drawing --------------------------------------------------------------------------------
  const named = [];
  const name = (text, place, className) => {
    const shown = element("span", text, className);
    labels.append(shown);
    named.push({ shown, place, className });
  };
  const rim = 1.04 * reach;
  [["N", 0, rim], ["E", rim, 0], ["S", 0, -rim], ["W", -rim, 0]].forEach(([text, x, y]) =>
    name(text, new THREE.Vector3(base.x + x, base.y + y, base.z), "of-compass"));
  const few = data.zones.length <= 40;
  if (few) for (const zone of data.zones) if (zone.place) name(zone.name, vector(zone.place), "of-zone");
  $("show-labels").checked = few;
  $("show-labels").disabled = !few;

  // Letters of the compass behind the building are hidden, as its sun path is.
  const sight = new THREE.Raycaster(), towards = new THREE.Vector3();
  function covered(where) {
    sight.set(camera.position, towards.copy(where).sub(camera.position).normalize());
    sight.far = camera.position.distanceTo(where);
    return sight.intersectObjects(parts.filter(({ mesh }) => mesh.visible).map(({ mesh }) => mesh), false).length > 0;
  }

  const projected = new THREE.Vector3();
  function place() {
    for (const { shown, place: where, className } of named) {
      projected.copy(where).project(camera);
      const on = className === "of-zone" ? $("show-labels").checked : $("show-sun").checked;
      shown.hidden = !on || projected.z > 1 || (className === "of-compass" && covered(where));
      // Parts of the drawing, so that names are where they belong on paper, too.
      shown.style.left = `${(50 * (projected.x + 1)).toFixed(2)}%`;
      shown.style.top = `${(50 * (1 - projected.y)).toFixed(2)}%`;
    }
  }

  let asked = false;
  function render() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      renderer.render(scene, camera);
      place();
      canvas.dataset.drawn = String(1 + Number(canvas.dataset.drawn || 0));
    });
  }

  // --- the eye -----------------------------------------------------------------------------------------------
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.target.copy(centre);
  controls.maxDistance = 40 * size;
  controls.addEventListener("change", render);
  const eyes = {
    "south-east": [0.75, -1, 0.62], "south-west": [-0.75, -1, 0.62], "north-east": [0.75, 1, 0.62],
    south: [0, -1, 0.25], above: [0, -0.001, 1],
  };
  function look(from) {
    // As near as all corners of the building allow, and all places of the sun where its path is shown.
    const to = vector(eyes[from]).normalize();
    const right = new THREE.Vector3().crossVectors(camera.up, to).normalize(), up = new THREE.Vector3().crossVectors(to, right);
    const high = Math.tan(camera.fov * Math.PI / 360), wide = high * camera.aspect;
    let away = 0;
    const include = (p, room) => {
      const c = p.clone().sub(centre);
      away = Math.max(away, c.dot(to) + room * Math.max(Math.abs(c.dot(up)) / high, Math.abs(c.dot(right)) / wide));
    };
    for (const { points } of parts) for (const p of points) include(p, 1.18);
    if ($("show-sun").checked) for (const p of [...inSky, ...circle]) include(p, 1.06);
    controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(to, away);
    camera.near = size / 50;
    camera.far = 100 * size;
    camera.updateProjectionMatrix();
    controls.update();
    render();
  }
  controls.addEventListener("start", () => { $("view-from").value = ""; });
  function turn(right, up) {
    const offset = camera.position.clone().sub(controls.target);
    offset.applyAxisAngle(camera.up, right);
    const axis = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
    const raised = offset.clone().applyAxisAngle(axis, -up);
    if (Math.abs(raised.clone().normalize().z) < 0.995) offset.copy(raised);
    camera.position.copy(controls.target).add(offset);
    controls.update();
    render();
  }
  const zoom = (factor) => { camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target); controls.update(); render(); };

  // --- selection ---------------------------------------------------------------------------------------------
  let selected = null;
  function select(number) {
    if (selected !== null) parts[selected].mesh.material.emissive.set(0x000000);
    selected = number;
    const box = $("selected");
    for (const button of document.querySelectorAll(".pick")) button.setAttribute("aria-pressed", String(+button.dataset.part === number));
    box.replaceChildren();
    if (number === null) { render(); return; }
    const { part, mesh } = parts[number];
    mesh.material.emissive.set(0x9a7a00);
    box.append(element("h3", `${part.kind === "surface" ? "Surface" : part.kind === "window" ? "Window" : "Shade"} ${part.name}`));
    for (const line of part.warnings) box.append(element("p", line, "warning"));
    const list = element("dl", undefined, "pairs");
    for (const [key, value] of part.facts) {
      const row = element("div");
      row.append(element("dt", key), element("dd", value));
      list.append(row);
    }
    box.append(list);
    const drawn = part.kind === "surface" ? $(`construction-${data.constructions[part.construction]}`) : null;
    if (drawn) {
      const copy = drawn.cloneNode(true);
      copy.removeAttribute("id");
      copy.querySelector(".caption")?.remove();
      box.append(copy);
    }
    render();
  }
  const caster = new THREE.Raycaster();
  let pressed = null;
  canvas.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 5) return;
    const area = canvas.getBoundingClientRect();
    caster.setFromCamera(new THREE.Vector2(
      2 * (event.clientX - area.left) / area.width - 1, 1 - 2 * (event.clientY - area.top) / area.height), camera);
    const hit = caster.intersectObjects(parts.filter(({ mesh }) => mesh.visible).map(({ mesh }) => mesh), false)[0];
    select(hit ? hit.object.userData.id : null);
  });
  canvas.addEventListener("keydown", (event) => {
    const step = 0.12, count = parts.length;
    const actions = {
      ArrowLeft: () => turn(-step, 0), ArrowRight: () => turn(step, 0), ArrowUp: () => turn(0, step), ArrowDown: () => turn(0, -step),
      "+": () => zoom(0.88), "=": () => zoom(0.88), "-": () => zoom(1 / 0.88), Escape: () => select(null),
      n: () => select(selected === null ? 0 : (selected + 1) % count), p: () => select(selected === null ? count - 1 : (selected + count - 1) % count),
    };
    const action = event.ctrlKey || event.metaKey || event.altKey ? null : actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    $("view-from").value = "";
    action();
  });
  for (const button of document.querySelectorAll(".pick")) button.addEventListener("click", () => {
    select(+button.dataset.part);
    if (canvas.getBoundingClientRect().bottom < 60) $("viewer").scrollIntoView({ block: "start" });
  });

  // --- controls ----------------------------------------------------------------------------------------------
  $("color-by").addEventListener("change", (event) => { scheme = event.target.value; paint(); });
  $("view-from").addEventListener("change", (event) => event.target.value && look(event.target.value));
  for (const id of ["show-normals", "show-inside", "show-labels"]) $(id).addEventListener("change", show);
  for (const id of ["show-sun", "show-shadows", "day", "hour"]) $(id).addEventListener("input", shine);
  function theme() {
    edges.color.set(css("--ink"));
    marked.color.set(css("--fail"));
    arrows.color.set(css("--ink"));
    faint.color.set(css("--soft"));
    floor.material.color.set(css("--hair"));
    render();
  }
  let framed = false;
  function resize() {
    const wide = canvas.parentElement.clientWidth, high = canvas.parentElement.clientHeight;
    if (!wide || !high) return;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(wide, high, false);
    camera.aspect = wide / high;
    camera.updateProjectionMatrix();
    if (!framed) { framed = true; $("view-from").value = "south-east"; }
    if ($("view-from").value) look($("view-from").value); // until the reader turns it
    render();
  }
  new ResizeObserver(resize).observe(canvas.parentElement);
  for (const query of ["(prefers-color-scheme: dark)", "print"]) matchMedia(query).addEventListener("change", theme);
  addEventListener("beforeprint", () => { for (const d of document.querySelectorAll("main details")) d.open = true; });
  theme();
  paint();
  shine();
  resize();
})();
