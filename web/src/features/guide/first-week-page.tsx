import { say } from '@/language';
import { Card } from '@/ui';
import { kFirstWeek } from './first-week';
import styles from './guide.module.css';
import { isMade, Steps } from './steps';

/** A residency's first week, day by day. */
export function FirstWeekPage() {
  return (
    <>
      <p className={styles.for}>
        {say('A residency’s first week: 24 residents, two kiosks, one certificate.')}
        {isMade('week-import')
          ? ` ${say('The pictures were made by a program, on a real server with simulated hands.')}`
          : null}
      </p>
      {kFirstWeek.map(({ name, steps }) => (
        <Card key={name} title={say(name)}>
          <Steps of={steps} />
        </Card>
      ))}
    </>
  );
}
