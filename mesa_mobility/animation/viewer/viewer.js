// Plays a run that is embedded in the page as a binary glTF file, with nothing from the network.
"use strict";

const element = (id) => document.getElementById(id);
const view = element("view");
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xdfe3e6);
scene.add(new THREE.HemisphereLight(0xffffff, 0x9a958c, 2.2));
const sun = new THREE.DirectionalLight(0xffffff, 1.6);
sun.position.set(5, 12, 7);
scene.add(sun);
const renderer = new THREE.WebGLRenderer({ antialias: false });
view.appendChild(renderer.domElement);
const perspective = new THREE.PerspectiveCamera(50, 1, 0.05, 500);
const above = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 500);
const orbit = new THREE.OrbitControls(perspective, renderer.domElement);
const FRAME = 1 / 30;
const EYES = 0.1; // metres from the head's joint up to the eyes
const state = { time: 0, playing: true, duration: 1, people: [], drawn: 0 };
let mixer = null;
let floor = new THREE.Box3();

function bytes(text) {
  const plain = atob(text);
  const found = new Uint8Array(plain.length);
  for (let k = 0; k < plain.length; k += 1) found[k] = plain.charCodeAt(k);
  return found.buffer;
}

function resize() {
  const { innerWidth: width, innerHeight: height } = window;
  renderer.setSize(width, height);
  perspective.aspect = width / height;
  perspective.updateProjectionMatrix();
  const middle = floor.getCenter(new THREE.Vector3());
  const size = floor.getSize(new THREE.Vector3());
  const half = Math.max(size.z / 2, (size.x / 2) * (height / width)) * 1.15;
  above.left = (-half * width) / height;
  above.right = (half * width) / height;
  above.top = half;
  above.bottom = -half;
  above.position.set(middle.x, 50, middle.z);
  above.up.set(0, 0, -1);
  above.lookAt(middle.x, 0, middle.z);
  above.updateProjectionMatrix();
}

function look() {
  const middle = floor.getCenter(new THREE.Vector3());
  const size = floor.getSize(new THREE.Vector3());
  const far = Math.max(size.x, size.z) * 0.75;
  perspective.position.set(middle.x + far * 0.5, far * 0.7 + 2, middle.z + far);
  orbit.target.set(middle.x, 0.8, middle.z);
  orbit.update();
}

function chosen() {
  return state.people[element("person").selectedIndex];
}

function place(camera) {
  const how = element("camera").value;
  orbit.enabled = how === "orbit" || how === "follow";
  if (how === "orbit" || how === "plan" || !chosen()) return orbit.enabled && orbit.update();
  const head = chosen().head.getWorldPosition(new THREE.Vector3());
  if (how === "follow") {
    const moved = head.clone().sub(orbit.target);
    orbit.target.copy(head);
    camera.position.add(moved);
    const away = camera.position.clone().sub(head);
    if (away.length() > 6) camera.position.copy(head).addScaledVector(away.normalize(), 5);
    return orbit.update();
  }
  // The skeleton faces x, which the world turns nowhere.
  const turned = chosen().head.getWorldQuaternion(new THREE.Quaternion());
  const ahead = new THREE.Vector3(1, 0, 0).applyQuaternion(turned);
  camera.position.copy(head).addScaledVector(ahead, 0.12);
  camera.position.y += EYES;
  camera.lookAt(camera.position.clone().add(ahead));
}

function draw() {
  mixer.setTime(Math.min(state.time, state.duration - 1e-4));
  scene.updateMatrixWorld();
  const camera = element("camera").value === "plan" ? above : perspective;
  place(camera);
  renderer.render(scene, camera);
  state.drawn += 1;
  element("time").value = state.time;
  element("said").textContent = `${state.time.toFixed(2)} of ${state.duration.toFixed(1)} s`;
}

function play(on) {
  state.playing = on;
  element("play").textContent = on ? "Pause" : "Play";
}

function step(frames) {
  play(false);
  const next = (Math.round(state.time / FRAME) + frames) * FRAME;
  state.time = Math.min(Math.max(next, 0), state.duration);
}

function listen() {
  element("play").onclick = () => play(!state.playing);
  element("back").onclick = () => step(-1);
  element("on").onclick = () => step(1);
  element("time").oninput = () => {
    play(false);
    state.time = Number(element("time").value);
  };
  window.onkeydown = (event) => {
    if (event.target.tagName === "SELECT") return;
    const keys = { " ": () => play(!state.playing), ArrowLeft: () => step(-1), ArrowRight: () => step(1) };
    if (keys[event.key]) {
      event.preventDefault();
      keys[event.key]();
    }
  };
  window.onresize = resize;
  renderer.domElement.ondblclick = (event) => {
    const at = new THREE.Vector2(
      (event.clientX / window.innerWidth) * 2 - 1, 1 - (event.clientY / window.innerHeight) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, element("camera").value === "plan" ? above : perspective);
    const near = state.people.map((each) => ray.ray.distanceToPoint(each.head.getWorldPosition(new THREE.Vector3())));
    element("person").selectedIndex = near.indexOf(Math.min(...near));
  };
}

new THREE.GLTFLoader().parse(bytes(FILE), "", (file) => {
  scene.add(file.scene);
  file.scene.updateMatrixWorld(true);
  file.scene.traverse((each) => {
    if (each.name === "floor") floor.setFromObject(each);
    // Their bounds are those of the rest pose at the origin.
    if (each.isSkinnedMesh) each.frustumCulled = false;
    // A quarter of the work for each pixel where there is no graphics card.
    if (each.isMesh) {
      const { color, side } = each.material;
      each.material = new THREE.MeshLambertMaterial({ color, side });
    }
    const named = /^(\d+)\.?head$/.exec(each.name);
    if (named) state.people.push({ number: named[1], head: each });
  });
  for (const { number } of state.people) element("person").add(new Option(number));
  mixer = new THREE.AnimationMixer(file.scene);
  const clip = file.animations[0];
  mixer.clipAction(clip).play();
  state.duration = clip.duration;
  element("time").max = clip.duration;
  listen();
  resize();
  look();
  let before = performance.now();
  renderer.setAnimationLoop((now) => {
    const passed = Math.max(0, now - before) / 1000;
    before = now;
    if (state.playing) state.time = (state.time + passed * Number(element("speed").value)) % state.duration;
    draw();
  });
  document.body.dataset.ready = "yes";
}, (error) => { element("said").textContent = `cannot be shown: ${error.message}`; });
