import { useEffect, useState } from 'react';

/** The value once it has not changed for `still_ms`: limits requests while a person types or drags. */
export function useSettled<Value>(value: Value, still_ms: number): Value {
  const [settled, setSettled] = useState(value);
  useEffect(() => {
    const timer = setTimeout(() => setSettled(value), still_ms);
    return () => clearTimeout(timer);
  }, [value, still_ms]);
  return settled;
}
