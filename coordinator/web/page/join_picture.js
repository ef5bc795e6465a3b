// The picture on the page /join: the rows that this device has rendered.

// Limit of the width and of the height of the canvas, in pixels. Of a larger picture only every n-th pixel is shown.
const maxSide = 2048;

export class Picture {
  #canvas;
  #context;
  #note;
  #of = "";  // job and size of the picture that is shown
  #step = 1;  // every #step-th pixel is shown, in both directions

  /// `note`: an element that is hidden when the first rows are drawn.
  constructor(canvas, note) {
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d");
    this.#note = note;
  }

  /// Draws the rows [first, last) of a job's picture. The argument is a state that join_engine.js
  /// reports: {job, width, height, rows: {first, last, rgb}}. `rgb` has four bytes for each pixel: red,
  /// green, blue and alpha. Draws nothing if the state has no `rows`.
  draw({job, width, height, rows}) {
    if (!rows || !width || !height) return;
    const of = `${job} ${width} ${height}`;
    if (this.#of !== of) {
      this.#of = of;
      this.#step = Math.max(1, Math.ceil(Math.max(width, height) / maxSide));
      this.#canvas.width = Math.ceil(width / this.#step);
      this.#canvas.height = Math.ceil(height / this.#step);
      this.#note.hidden = true;
    }
    const step = this.#step;
    const line = this.#context.createImageData(this.#canvas.width, 1);
    for (let y = Math.ceil(rows.first / step) * step; y < rows.last; y += step) {
      for (let x = 0; x < this.#canvas.width; x++) {
        const at = ((y - rows.first) * width + x * step) * 4;
        line.data.set(rows.rgb.subarray(at, at + 4), 4 * x);
      }
      this.#context.putImageData(line, 0, y / step);
    }
  }
}
