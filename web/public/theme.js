// Runs before the first paint, so that a page that was set to dark never flashes white.
try {
  const chosen = localStorage.getItem('tractus-theme');
  if (chosen === 'light' || chosen === 'dark') document.documentElement.dataset.theme = chosen;
} catch {
  // Storage may be refused; the system's preference then holds.
}
