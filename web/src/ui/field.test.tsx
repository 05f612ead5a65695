// @vitest-environment jsdom
import { cleanup, render, screen } from '@testing-library/react';
import { afterEach, describe, expect, it } from 'vitest';
import { Field } from './field';

afterEach(cleanup);

describe('a field', () => {
  it('shows what is wrong with its value and tells it to a screen reader', () => {
    render(<Field label="Depth" error="Enter a value from 0.5 to 15 mm." defaultValue="99" />);
    const input = screen.getByLabelText('Depth');
    expect(input.getAttribute('aria-invalid')).toBe('true');
    expect(document.getElementById(input.getAttribute('aria-describedby') ?? '')?.textContent).toBe(
      'Enter a value from 0.5 to 15 mm.',
    );
  });

  it('is valid without an error', () => {
    render(<Field label="Depth" defaultValue="3" />);
    expect(screen.getByLabelText('Depth').hasAttribute('aria-invalid')).toBe(false);
    expect(screen.queryByRole('status')).toBeNull();
  });
});
