// Search without a server: browsers start no worker on a page from file://. There a hidden frame runs the script of the
// search in its place, with the three functions of a worker that it uses. On a server this file does nothing. It stands
// for the package iframe-worker, which Material for MkDocs would load from the network.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super()
      const frame = document.createElement("iframe")
      frame.hidden = true
      document.body.append(frame)
      const inside = frame.contentWindow
      inside.document.open()
      inside.document.write(`<script>
        window.postMessage = data => parent.postMessage(data, "*")
        window.importScripts = (...urls) => urls.reduce((before, url) => before.then(() => new Promise((done, failed) => {
          const script = document.createElement("script")
          Object.assign(script, { src: url, onload: done, onerror: failed })
          document.head.append(script)
        })), Promise.resolve())
      </script><script src="${url}"></script>`)
      inside.document.close()  // the listeners of before are gone by now
      this.ready = new Promise(done => inside.addEventListener("load", done, { once: true }))
      this.inside = inside
      window.addEventListener("message", event => {
        if (event.source !== inside) return
        const heard = new MessageEvent("message", { data: event.data })
        this.dispatchEvent(heard)
        if (this.onmessage) this.onmessage(heard)
      })
    }

    postMessage(data) {
      this.ready.then(() => this.inside.dispatchEvent(new MessageEvent("message", { data })))
    }
  }
}
