// Where the page's files come from: the server beside the page, or the page itself when a report carries its model.

/** A file that is not there or cannot be read. The message names it. */
export class FileMissing extends Error {
  constructor(
    readonly path: string,
    reason: string,
  ) {
    super(`${path}: ${reason}`);
  }
}

export class Files {
  private readonly embedded: Record<string, string> | null;
  private readonly base: string;

  constructor() {
    const holder = document.getElementById('blockrand-embedded');
    const parsed: unknown = holder ? JSON.parse(holder.textContent ?? '{}') : null;
    this.embedded = parsed ? ((parsed as { files?: Record<string, string> }).files ?? {}) : null;
    // A bundle beside a page of another folder is not foreseen: all paths are relative to the page.
    this.base = new URL('.', document.baseURI).toString();
  }

  /** The address under which the renderer asks for the file. */
  url(path: string): string {
    return new URL(path, this.base).toString();
  }

  async bytes(path: string, signal?: AbortSignal): Promise<ArrayBuffer> {
    return (await this.response(this.url(path), signal)).arrayBuffer();
  }

  async text(path: string): Promise<string> {
    return (await this.response(this.url(path))).text();
  }

  async json<T>(path: string): Promise<T> {
    const text = await this.text(path);
    try {
      return JSON.parse(text) as T;
    } catch {
      throw new FileMissing(path, 'is no JSON');
    }
  }

  /** Answers an address of `url`. Throws FileMissing, or what an abort throws. */
  async response(url: string, signal?: AbortSignal): Promise<Response> {
    const path =
      decodeURIComponent(url.startsWith(this.base) ? url.slice(this.base.length) : url).split(/[?#]/)[0] ?? '';
    if (this.embedded) {
      const held = this.embedded[path];
      if (held === undefined) throw new FileMissing(path, 'is not part of this page');
      const bytes = bytes_of(held);
      const is_gzip = bytes[0] === 0x1f && bytes[1] === 0x8b;
      return new Response(is_gzip ? new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')) : bytes);
    }
    let answer: Response;
    try {
      answer = await fetch(url, signal ? { signal } : {});
    } catch (error) {
      if ((error as Error).name === 'AbortError') throw error;
      throw new FileMissing(
        path,
        location.protocol === 'file:'
          ? 'a browser reads no files beside a page opened from disk; use `blockrand view`'
          : 'no answer from the server',
      );
    }
    if (!answer.ok) throw new FileMissing(path, `the server answers ${answer.status}`);
    return answer;
  }
}

function bytes_of(base64: string): Uint8Array<ArrayBuffer> {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
