/** Whether this page had a session that was not signed out: what the sign-in that follows has to explain. */
let present = false;

export const noteSession = () => {
  present = true;
};
export const noteSignOut = () => {
  present = false;
};

export function endedByItself(): boolean {
  return present;
}
