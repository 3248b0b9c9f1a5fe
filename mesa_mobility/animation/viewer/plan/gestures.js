// What pointer, wheel and fingers do on a canvas that shows part of a plane.

const CLICK_REACH = 4; // pixels within which a press is a click

class Gestures {
  // `view` has zoomAt(x, y, factor), pan(dx, dy), click(event) and remind(), in pixels of the page. With
  // `fixed`, where nothing scrolls, the wheel zooms and a finger moves the floor without more.
  constructor(canvas, view) {
    this.view = view;
    this.canvas = canvas;
    this.grip = this.pinch = null;
    const listen = (name, act) => canvas.addEventListener(name, act.bind(this), { passive: false });
    listen("pointerdown", this.press);
    listen("pointermove", this.move);
    listen("pointerup", this.release);
    listen("pointercancel", this.cancel);
    listen("wheel", this.wheel);
    listen("touchstart", this.touch);
    listen("touchmove", this.touch);
    listen("touchend", this.touch);
    listen("touchcancel", this.touch);
  }

  press(event) {
    if (!event.isPrimary || event.button !== 0) return;
    this.grip = { id: event.pointerId, x: event.clientX, y: event.clientY, moved: false };
    // One finger scrolls the page; a mouse keeps hold of the floor outside of the canvas, too.
    if (event.pointerType !== "touch") this.canvas.setPointerCapture(event.pointerId);
  }

  move(event) {
    const grip = this.grip;
    if (!grip || event.pointerId !== grip.id) return;
    const dx = event.clientX - grip.x, dy = event.clientY - grip.y;
    if (!grip.moved && Math.hypot(dx, dy) < CLICK_REACH) return;
    Object.assign(grip, { moved: true, x: event.clientX, y: event.clientY });
    if (event.pointerType !== "touch" || this.view.fixed) this.view.pan(dx, dy);
  }

  release(event) {
    const grip = this.grip;
    if (!grip || event.pointerId !== grip.id) return;
    this.grip = null;
    if (!grip.moved) this.view.click(event);
  }

  cancel() {
    this.grip = null;
  }

  wheel(event) {
    if (!event.ctrlKey && !event.metaKey && !this.view.fixed) {
      this.view.remind();
      return;
    }
    event.preventDefault();
    const delta = Math.min(Math.max(event.deltaY * (event.deltaMode ? 16 : 1), -400), 400);
    this.view.zoomAt(event.clientX, event.clientY, Math.exp(-delta / 500));
  }

  touch(event) {
    const [a, b] = event.touches;
    if (!b) {
      this.pinch = null;
      return;
    }
    event.preventDefault();
    this.grip = null;
    const now = { x: (a.clientX + b.clientX) / 2, y: (a.clientY + b.clientY) / 2,
      far: Math.max(Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY), 1) };
    const before = event.type === "touchmove" ? this.pinch : null;
    this.pinch = now;
    if (!before) return;
    this.view.pan(now.x - before.x, now.y - before.y);
    this.view.zoomAt(now.x, now.y, now.far / before.far);
  }
}
