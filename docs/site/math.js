// Formulas by KaTeX, which lies beside the pages, on pages that have some.
if (document.querySelector(".arithmatex")) {
  const folder = new URL("katex/", document.currentScript.src);
  const style = document.createElement("link");
  style.rel = "stylesheet";
  style.href = new URL("katex.min.css", folder);
  const script = document.createElement("script");
  script.src = new URL("katex.min.js", folder);
  script.onload = () => {
    for (const formula of document.querySelectorAll(".arithmatex")) {
      const text = formula.textContent.trim();
      katex.render(text.slice(2, -2), formula, {displayMode: text.startsWith("\\["), throwOnError: false});
    }
  };
  document.head.append(style, script);
}
