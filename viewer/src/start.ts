// Starts the viewer in an element: BlockrandView.start(element), which a report calls. The element of index.html asks
// for it by an attribute: the server's Content-Security-Policy lets no script of the page itself run.
import { describe, View } from './view';
import { Files, FileMissing } from './files';
import { Page } from './page';

/** Shows the build in `element`, or says in it why that cannot be. */
export async function start(element: HTMLElement): Promise<View | null> {
  const page = new Page(element);
  const files = new Files();
  try {
    const told = describe(await files.json('view.json'));
    const view = new View(page, files, told);
    (window as unknown as { blockrandView: unknown }).blockrandView = view.for_tests;
    view.run();
    return view;
  } catch (error) {
    page.loading(false);
    if (error instanceof FileMissing) page.fail('A file of the page is missing', error.message);
    else page.fail('The houses cannot be shown', (error as Error).message);
    const message = page.failures[0] ?? '';
    (window as unknown as { blockrandView: unknown }).blockrandView = {
      ready: Promise.reject(new Error(message)),
      frameTimes: () => [],
      memory: () => ({ bytes: 0, tiles: 0 }),
      state: () => ({ failures: page.failures }),
    };
    (window as unknown as { blockrandView: { ready: Promise<void> } }).blockrandView.ready.catch(() => {});
    return null;
  }
}

const own = document.querySelector<HTMLElement>('[data-blockrand-start]');
if (own) void start(own);
