/** The whole: which address shows which page, and what an ended session does to all of them. */
import { QueryCache, QueryClient, QueryClientProvider, useQuery } from '@tanstack/react-query';
import { Suspense, type ReactNode } from 'react';
import { Link, Redirect, Route, Switch, useLocation } from 'wouter';
import { ApiError, endSession, sessionQuery } from '@/api';
import { Account, OwnAccountPage, SessionGate } from '@/features/session';
import { NewStudyPage, StudiesPage } from '@/features/studies';
import { StudyPage } from '@/features/study';
import { TrialsPage } from '@/features/trials';
import { Notice, Shell, Skeleton, useTitle } from '@/ui';
import styles from './app.module.css';
import { Fault } from './fault';
import {
  TrialPage, LabPage, WorkPage, PeoplePage, CohortsPage, StationsPage, BackupsPage, StationPage, WallPage, AuditPage, GuidePage, AnalysisPage, ExamplePage, NewPlanPage, PlanPage, RunPage, TraineesPage, TraineePage, CasesPage, CasePage, NewCasePage, AssignmentsPage, AssignmentPage, NewAssignmentPage, ScenariosPage, ScenarioPage, DebriefPage, VersionsPage,
} from './later-pages';

export function makeClient(): QueryClient {
  const onError = (reason: Error) => {
    if (reason instanceof ApiError && reason.code === 'unauthorised') endSession(client);
  };
  const client = new QueryClient({
    queryCache: new QueryCache({ onError }),
    // The server is in the house: whether the browser thinks that there is an Internet says nothing about it.
    defaultOptions: {
      mutations: { networkMode: 'always' },
      queries: {
        networkMode: 'always',
        staleTime: 5_000,
        retry: (failures, reason) =>
          failures < 2 && reason instanceof ApiError && (reason.code === 'unreachable' || reason.code === 'unavailable'),
        retryDelay: (failures) => 500 * 2 ** failures,
      },
    },
  });
  return client;
}

/** Which places a role has; the server decides again on every call. */
const kPlaces = [
  { to: '/assignments', name: 'My work', roles: ['trainee'] },
  { to: '/trials', name: 'Trials', roles: ['admin', 'director', 'faculty', 'trainee'] },
  { to: '/cases', name: 'Cases', roles: ['admin', 'director', 'faculty', 'researcher'] },
  { to: '/scenarios', name: 'Scenarios', roles: ['admin', 'faculty'] },
  { to: '/assignments', name: 'Assignments', roles: ['admin', 'director', 'faculty'] },
  { to: '/trainees', name: 'Trainees', roles: ['admin', 'director', 'faculty'] },
  { to: '/me', name: 'My curve', roles: ['trainee'] },
  { to: '/studies', name: 'Studies', roles: ['admin', 'researcher'] },
  { to: '/analysis', name: 'Analysis', roles: ['admin', 'researcher'] },
  { to: '/lab', name: 'Model lab', roles: ['admin', 'researcher'] },
  { to: '/wall', name: 'Live', roles: ['admin', 'director', 'faculty', 'technician'] },
  { to: '/network', name: 'Network', roles: ['admin', 'director', 'faculty', 'technician'] },
  { to: '/guide', name: 'Guide', roles: ['admin', 'director', 'faculty', 'researcher', 'technician', 'trainee'] },
] as const;
const kNetwork: Record<string, string> = { admin: 'people', technician: 'stations' };

const open = (role: string) => kPlaces.filter(({ roles }) => (roles as readonly string[]).includes(role));

function Brand() {
  const [at] = useLocation();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  return (
    <div className={styles.home}>
      <Link href="/" className={styles.brand}>
        <img src="/icon.svg" alt="" width="24" height="24" />
        Tractus
      </Link>
      {role === undefined ? null : (
        <nav aria-label="Pages" className={styles.places}>
          {open(role).map(({ to, name }) => (
            <Link key={to} href={to} className={styles.place} aria-current={at === to || at.startsWith(`${to}/`) ? 'page' : undefined}>{name}</Link>
          ))}
        </nav>
      )}
    </div>
  );
}

/** Where a role begins. */
function Home() {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  return <Redirect to={open(role)[0]?.to ?? '/account'} replace />;
}

/** A trainee's own page. */
function Me() {
  const session = useQuery({ ...sessionQuery, enabled: false }).data;
  return session ? <TraineePage name={session.name} /> : null;
}

function Network() {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  return <Redirect to={`/network/${kNetwork[role] ?? 'cohorts'}`} replace />;
}

function NotFound() {
  useTitle('Not found');
  return (
    <div className={styles.narrow}>
      <h1>There is no such page</h1>
      <p>The address may be mistyped, or what it named is gone.</p>
      <p><Link href="/">To the beginning</Link></p>
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
        <Route path="/"><Home /></Route>
        <Route path="/account"><OwnAccountPage /></Route>
        <Route path="/guide/:role?">{({ role }) => <GuidePage role={role} />}</Route>
        <Route path="/me"><Me /></Route>
        <Route path="/trainees"><TraineesPage /></Route>
        <Route path="/trainees/:name">{({ name }) => <TraineePage key={name} name={decodeURIComponent(name)} />}</Route>
        <Route path="/network"><Network /></Route>
        <Route path="/network/people"><PeoplePage /></Route>
        <Route path="/network/cohorts"><CohortsPage /></Route>
        <Route path="/network/stations"><StationsPage /></Route>
        <Route path="/network/stations/:id">{({ id }) => <StationPage key={id} id={id} />}</Route>
        <Route path="/network/backups"><BackupsPage /></Route>
        <Route path="/wall"><WallPage /></Route>
        <Route path="/network/audit"><AuditPage /></Route>
        <Route path="/trials"><TrialsPage /></Route>
        <Route path="/cases"><CasesPage /></Route>
        <Route path="/cases/new/:volume">{({ volume }) => <NewCasePage key={volume} volume={volume} />}</Route>
        <Route path="/cases/:id">{({ id }) => <CasePage key={id} id={id} />}</Route>
        <Route path="/scenarios"><ScenariosPage /></Route>
        <Route path="/scenarios/:id">{({ id }) => <ScenarioPage key={id} id={id} />}</Route>
        <Route path="/assignments"><AssignmentsPage /></Route>
        <Route path="/assignments/new"><NewAssignmentPage /></Route>
        <Route path="/assignments/:id">{({ id }) => <AssignmentPage key={id} id={id} />}</Route>
        <Route path="/trials/:id/debrief">{({ id }) => <DebriefPage key={id} id={id} />}</Route>
        <Route path="/trials/:id">{({ id }) => <TrialPage key={id} id={id} />}</Route>
        <Route path="/studies"><StudiesPage /></Route>
        <Route path="/studies/new"><NewStudyPage /></Route>
        <Route path="/studies/:id">{({ id }) => <StudyPage key={id} id={id} />}</Route>
        <Route path="/analysis"><AnalysisPage /></Route>
        <Route path="/analysis/example"><ExamplePage /></Route>
        <Route path="/analysis/plans/new"><NewPlanPage /></Route>
        <Route path="/analysis/plans/:id">{({ id }) => <PlanPage key={id} id={id} />}</Route>
        <Route path="/analysis/runs/:id">{({ id }) => <RunPage key={id} id={id} />}</Route>
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

export function App({ client }: { readonly client: QueryClient }) {
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
