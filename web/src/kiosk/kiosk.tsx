/** The station's full-screen page: it shows the station's state and sends what a person touches; it decides nothing. */
import { useEffect } from 'react';
import { preferredLanguage, readLanguage, say, speak, useLanguage } from '@/language';
import { Badge } from '@/ui';
import { AnswerScreen } from './answer-screen';
import { FaultScreen, LostScreen } from './fault-screens';
import { BadgeScreen, PinScreen } from './sign-in-screens';
import { TechnicianScreen, TestScreen } from './technician-screen';
import { useStation, type Send, type State } from './station';
import { CompleteScreen, PausedScreen, ResultScreen, RunningScreen, WaitScreen, WorkScreen } from './work-screens';
import styles from './kiosk.module.css';

function Screen({ state, send }: { readonly state: State; readonly send: Send }) {
  switch (state.screen) {
    case 'badge':
      return <BadgeScreen {...state} send={send} />;
    case 'pin':
      return <PinScreen title={say('Type your PIN')} notice={state.notice} send={send} />;
    case 'technician_pin':
      return <PinScreen title={say('Technician’s PIN')} notice={state.notice} send={send} />;
    case 'technician':
      return <TechnicianScreen {...state} send={send} />;
    case 'testing':
      return <TestScreen text={state.test?.text ?? ''} waits={state.test?.waits ?? false} send={send} />;
    case 'checking':
      return <WaitScreen text={state.study ? say('Checking your number') : say('Checking badge and PIN')} />;
    case 'work':
      return state.work ? <WorkScreen work={state.work} button={state.button} send={send} /> : null;
    case 'preparing':
      return <WaitScreen text={say('Getting ready')} />;
    case 'running':
      return state.live ? <RunningScreen live={state.live} work={state.work} send={send} /> : null;
    case 'answer':
      return state.question ? <AnswerScreen {...state.question} send={send} /> : null;
    case 'saving':
      return <WaitScreen text={say('Saving your trial')} />;
    case 'result':
      return state.outcome ? <ResultScreen study={state.study} outcome={state.outcome} send={send} /> : null;
    case 'paused':
      return <PausedScreen inTrial={state.in_trial} send={send} />;
    case 'complete':
      return <CompleteScreen send={send} />;
    case 'fault':
      return state.fault ? <FaultScreen fault={state.fault} waiting={state.waiting_trials} send={send} /> : null;
  }
}

export function Kiosk() {
  const { state, connection, send, connect } = useStation();
  const spoken = useLanguage();
  const theirs = readLanguage(state?.language);
  useEffect(() => {
    speak(theirs ?? preferredLanguage()).catch(() => undefined);
  }, [theirs]);
  const known = connection === 'open' ? state : null;
  return (
    <div key={spoken} className={styles.page} data-screen={known ? known.screen : connection}>
      <header className={styles.bar}>
        <strong>Tractus</strong>
        {known?.simulated ? <Badge tone="warn">{say('SIMULATED device')}</Badge> : null}
        {known && known.waiting_trials > 0 ? (
          <Badge tone="neutral">
            {say('{waiting, plural, one {# trial waits} other {# trials wait}} to be sent', {
              waiting: known.waiting_trials,
            })}
          </Badge>
        ) : null}
        <span className={styles.name}>{known?.name}</span>
      </header>
      <main className={styles.main}>
        {known ? <Screen state={known} send={send} /> : <LostScreen connection={connection} onConnect={connect} />}
      </main>
    </div>
  );
}
