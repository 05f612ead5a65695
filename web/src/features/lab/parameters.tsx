import type { Estimate } from '@/api';
import { say } from '@/language';
import { Badge, Scroll, Term } from '@/ui';
import { formatWithin, nameAndUnit } from '@/units';
import styles from './lab.module.css';
import { effectName } from './names';

/** "/base/layers/0/stiffness_N_per_m" → "Layer 1, stiffness"; "coulomb_friction/friction_N" → "Coulomb friction, friction". */
export function parameterName(pointer: string): { name: string; unit: string } {
  const parts = pointer.split('/').filter(Boolean);
  const numbered = parts.at(-1) !== undefined && /^\d+$/.test(parts.at(-1) ?? '');
  const own = nameAndUnit((numbered ? parts.at(-2) : parts.at(-1)) ?? pointer);
  const component = numbered ? ` ${['x', 'y', 'z'][Number(parts.at(-1))] ?? parts.at(-1) ?? ''}` : '';
  const rest = parts.slice(0, numbered ? -2 : -1);
  const place =
    rest[0] !== 'base' && rest[0] !== undefined
      ? effectName(rest[0])
      : rest[1] === 'layers'
        ? say('Layer {number}', { number: Number(rest[2] ?? 0) + 1 })
        : rest.slice(1).join(' ');
  const words = place === '' ? own.name : `${place}, ${own.name}`;
  return { name: words.charAt(0).toUpperCase() + words.slice(1) + component, unit: own.unit };
}

export function Parameters({ estimates }: { readonly estimates: readonly Estimate[] }) {
  return (
    <Scroll label={say('Fitted parameters')}>
      <table className={styles.table}>
        <caption className="hidden-visually">{say('Fitted parameters')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Parameter')}</th>
            <th scope="col" className={styles.number}>
              <Term align="end" definition={say('Fitted value and its standard error, from the curvature of the fit.')}>
                {say('Value')}
              </Term>
            </th>
            <th scope="col">{say('Assessment')}</th>
          </tr>
        </thead>
        <tbody>
          {estimates.map((one) => {
            const { name, unit } = parameterName(one.name);
            return (
              <tr key={one.name}>
                <th scope="row">{name}</th>
                <td className={styles.number}>{formatWithin(one.value, one.sd, unit)}</td>
                <td>
                  {!one.informed ? (
                    <Badge tone="warn">{say('not determined by these measurements')}</Badge>
                  ) : one.at_bound ? (
                    <Badge tone="warn">{say('at a bound')}</Badge>
                  ) : (
                    <span className={styles.muted}>{say('determined')}</span>
                  )}
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </Scroll>
  );
}
