import { useEffect, useState } from 'react';

/** Follows a value once it has been still for so long: for questions that cost the server something. */
export function useSettled<Value>(value: Value, still_ms: number): Value {
  const [settled, setSettled] = useState(value);
  useEffect(() => {
    const timer = setTimeout(() => setSettled(value), still_ms);
    return () => clearTimeout(timer);
  }, [value, still_ms]);
  return settled;
}
