// What a screenshot shows, in numbers, for view_page.mjs: colours, light, hues, and how far two pictures differ.

/**
 * A function that takes a PNG and gives {colours, light, hues: [36 shares], small: grey values}. PNGs are read by the
 * browser, on an empty page of its own.
 */
export async function picture_reader(browser) {
  const reader = await browser.newPage();
  return async (png) => {
    return reader.evaluate(async (base64) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
      const canvas = new OffscreenCanvas(image.width, image.height),
        context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      const colours = new Set();
      let light = 0;
      const hues = new Array(36).fill(0);
      const small = [];
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
        colours.add(((r >> 2) << 12) | ((g >> 2) << 6) | (b >> 2));
        light += 0.2126 * r + 0.7152 * g + 0.0722 * b;
        const most = Math.max(r, g, b),
          spread = most - Math.min(r, g, b);
        if (spread > 40) {
          const hue =
            most === r ? ((g - b) / spread + 6) % 6 : most === g ? (b - r) / spread + 2 : (r - g) / spread + 4;
          hues[Math.floor(hue * 6) % 36] += 1;
        }
        if ((i / 4) % 7 === 0) small.push(((r + g + b) / 3) | 0);
      }
      const count = data.length / 4;
      return { colours: colours.size, light: light / count, hues: hues.map((n) => n / count), small };
    }, png.toString('base64'));
  };
}

/** Share of the pixels that differ. */
export const difference = (a, b) =>
  a.small.reduce((n, value, i) => n + (Math.abs(value - b.small[i]) > 12), 0) / a.small.length;

/** Of two points. */
export const distance = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));

/** Of a CSS colour: 0 to 36, or null where it is nearly grey. */
export const hue_of = (rgb) => {
  const [r, g, b] = rgb.match(/\d+/g).map(Number),
    most = Math.max(r, g, b),
    spread = most - Math.min(r, g, b);
  if (spread < 60) return null;
  return (most === r ? ((g - b) / spread + 6) % 6 : most === g ? (b - r) / spread + 2 : (r - g) / spread + 4) * 6;
};
