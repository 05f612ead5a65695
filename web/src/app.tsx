/** The whole: which address shows which page, and what an ended session does to all of them. */
import { QueryCache, QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { lazy, Suspense, useState, type ReactNode } from 'react';
import { Link, Redirect, Route, Switch, useLocation } from 'wouter';
import { ApiError, endSession } from '@/api';
import { Account, SessionGate } from '@/features/session';
import { NewStudyPage, StudiesPage } from '@/features/studies';
import { StudyPage } from '@/features/study';
import { TrialsPage } from '@/features/trials';
import { Notice, Shell, Skeleton, useTitle } from '@/ui';
import styles from './app.module.css';
import { Fault } from './fault';

const TrialPage = lazy(() => import('@/features/trial'));
const lab = () => import('@/features/lab');
const LabPage = lazy(() => lab().then(({ LabPage: page }) => ({ default: page })));
const WorkPage = lazy(() => lab().then(({ WorkPage: page }) => ({ default: page })));
const VersionsPage = lazy(() => lab().then(({ VersionsPage: page }) => ({ default: page })));

function makeClient(): QueryClient {
  const onError = (reason: Error) => {
    if (reason instanceof ApiError && reason.code === 'unauthorised') endSession(client);
  };
  const client = new QueryClient({
    queryCache: new QueryCache({ onError }),
    defaultOptions: {
      queries: {
        staleTime: 5_000,
        retry: (failures, reason) =>
          failures < 2 && reason instanceof ApiError && (reason.code === 'unreachable' || reason.code === 'unavailable'),
        retryDelay: (failures) => 500 * 2 ** failures,
      },
    },
  });
  return client;
}

const kPlaces = [
  { to: '/trials', name: 'Trials' },
  { to: '/studies', name: 'Studies' },
  { to: '/lab', name: 'Model lab' },
] as const;

function Brand() {
  const [at] = useLocation();
  return (
    <div className={styles.home}>
      <Link href="/trials" className={styles.brand}>
        <img src="/icon.svg" alt="" width="24" height="24" />
        Tractus
      </Link>
      <nav aria-label="Pages" className={styles.places}>
        {kPlaces.map(({ to, name }) => (
          <Link key={to} href={to} className={styles.place} aria-current={at === to || at.startsWith(`${to}/`) ? 'page' : undefined}>{name}</Link>
        ))}
      </nav>
    </div>
  );
}

function NotFound() {
  useTitle('Not found');
  return (
    <div className={styles.narrow}>
      <h1>There is no such page</h1>
      <p>The address may be mistyped, or what it named is gone.</p>
      <p><Link href="/trials">To the list of trials</Link></p>
    </div>
  );
}

function Loading() {
  return <div className={styles.loading} role="status"><span className="hidden-visually">Loading</span><Skeleton height="40px" width="320px" /></div>;
}

function Pages() {
  return (
    <Suspense fallback={<Loading />}>
      <Switch>
        <Route path="/"><Redirect to="/trials" replace /></Route>
        <Route path="/trials"><TrialsPage /></Route>
        <Route path="/trials/:id">{({ id }) => <TrialPage key={id} id={id} />}</Route>
        <Route path="/studies"><StudiesPage /></Route>
        <Route path="/studies/new"><NewStudyPage /></Route>
        <Route path="/studies/:id">{({ id }) => <StudyPage key={id} id={id} />}</Route>
        <Route path="/lab"><LabPage /></Route>
        <Route path="/lab/versions"><VersionsPage /></Route>
        <Route path="/lab/work/:model/:set/:step?">{({ model, set, step }) => <WorkPage key={`${model} ${set}`} model={model} set={set} step={step ?? 'compare'} />}</Route>
        <Route><NotFound /></Route>
      </Switch>
    </Suspense>
  );
}

function Framed({ children }: { readonly children: ReactNode }) {
  return <Shell home={<Brand />} account={<Account />}>{children}</Shell>;
}

export function App() {
  const [client] = useState(makeClient);
  return (
    <QueryClientProvider client={client}>
      <Framed>
        <Fault fallback={<Notice tone="bad" title="This page has failed.">Reload it. If it fails again, tell who runs the server what you did.</Notice>}>
          <SessionGate waiting={<Loading />}><Pages /></SessionGate>
        </Fault>
      </Framed>
    </QueryClientProvider>
  );
}
